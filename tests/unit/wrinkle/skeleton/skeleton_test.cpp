// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/skeleton.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/wrinkle/test_characters.h"

namespace furrow::wrinkle {
namespace {

std::vector<JointDesc> ThreeJoints() {
  std::vector<JointDesc> joints(3);
  joints[0].name = "root";
  joints[1].name = "middle";
  joints[1].parent = 0;
  joints[1].rest.translation = {0.0f, 2.0f, 0.0f};
  joints[2].name = "leaf";
  joints[2].parent = 1;
  joints[2].rest.translation = {1.0f, 0.0f, 0.0f};
  return joints;
}

StatusCode CodeOf(std::vector<JointDesc> joints) {
  return Skeleton::Create(std::move(joints)).status().code();
}

TEST(SkeletonCreate, AcceptsAChain) { EXPECT_EQ(CodeOf(ThreeJoints()), StatusCode::kOk); }

TEST(SkeletonCreate, RefusesNoJoints) { EXPECT_EQ(CodeOf({}), StatusCode::kLimit); }

TEST(SkeletonCreate, RefusesTooManyJoints) {
  std::vector<JointDesc> joints(kMaxJoints + 1);
  for (std::size_t i = 0; i < joints.size(); ++i) joints[i].name = std::to_string(i);
  EXPECT_EQ(CodeOf(joints), StatusCode::kLimit);
  joints.pop_back();
  EXPECT_EQ(CodeOf(joints), StatusCode::kOk);
}

TEST(SkeletonCreate, RefusesBadNames) {
  std::vector<JointDesc> joints = ThreeJoints();
  joints[1].name.clear();
  EXPECT_EQ(CodeOf(joints), StatusCode::kInvalidArgument);
  joints[1].name = "leaf";
  EXPECT_EQ(CodeOf(joints), StatusCode::kInvalidArgument);
  joints[1].name = std::string(256, 'x');
  EXPECT_EQ(CodeOf(joints), StatusCode::kInvalidArgument);
  joints[1].name = std::string(255, 'x');
  EXPECT_EQ(CodeOf(joints), StatusCode::kOk);
}

TEST(SkeletonCreate, RefusesParentsOutOfRange) {
  for (const int parent : {3, -2, 1000}) {
    std::vector<JointDesc> joints = ThreeJoints();
    joints[1].parent = parent;
    EXPECT_EQ(CodeOf(joints), StatusCode::kInvalidArgument) << parent;
  }
}

TEST(SkeletonCreate, RefusesCyclesAndNamesAJointOfTheCycle) {
  std::vector<JointDesc> joints = ThreeJoints();
  joints[1].parent = 1;  // "middle" is its own parent; "leaf" merely hangs from it
  const Status status = Skeleton::Create(joints).status();
  EXPECT_EQ(status.code(), StatusCode::kCyclic);
  EXPECT_NE(status.ToString().find("'middle'"), std::string::npos) << status.ToString();

  joints = ThreeJoints();
  joints[0].parent = 2;  // all three in a ring
  EXPECT_EQ(CodeOf(joints), StatusCode::kCyclic);
}

TEST(SkeletonCreate, RefusesWhatIsNotFinite) {
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(),
                       std::numeric_limits<float>::infinity()};
  for (const float value : bad) {
    std::vector<JointDesc> joints = ThreeJoints();
    joints[2].rest.translation.y = value;
    const Status status = Skeleton::Create(joints).status();
    EXPECT_EQ(status.code(), StatusCode::kNonFinite);
    EXPECT_NE(status.ToString().find("'leaf'"), std::string::npos) << status.ToString();
    joints = ThreeJoints();
    joints[2].rest.rotation.w = value;
    EXPECT_EQ(CodeOf(joints), StatusCode::kNonFinite);
    joints = ThreeJoints();
    joints[2].rest.scale.z = value;
    EXPECT_EQ(CodeOf(joints), StatusCode::kNonFinite);
    joints = ThreeJoints();
    joints[2].tail = glm::vec3(value, 0.0f, 0.0f);
    EXPECT_EQ(CodeOf(joints), StatusCode::kNonFinite);
  }
}

TEST(SkeletonCreate, RefusesRotationsThatAreNotUnit) {
  std::vector<JointDesc> joints = ThreeJoints();
  joints[1].rest.rotation = {2.0f, 0.0f, 0.0f, 0.0f};
  EXPECT_EQ(CodeOf(joints), StatusCode::kInvalidArgument);
}

TEST(SkeletonCreate, SortsParentsFirstAndKeepsOrderOtherwise) {
  std::vector<JointDesc> joints(5);
  const char* const names[] = {"leaf", "middle", "root", "second", "first"};
  const int parents[] = {1, 2, kNoJoint, 2, kNoJoint};
  for (int i = 0; i < 5; ++i) {
    joints[i].name = names[i];
    joints[i].parent = parents[i];
  }
  const Skeleton skeleton = Skeleton::Create(joints).value();
  for (int i = 0; i < skeleton.num_joints(); ++i) {
    EXPECT_LT(skeleton.joint_parents()[i], i);
    EXPECT_EQ(skeleton.joint_names()[i], names[skeleton.source_index()[i]]);
  }
  EXPECT_EQ(skeleton.joint_names()[skeleton.joint_parents()[skeleton.Find("leaf")]], "middle");

  const Skeleton sorted = Skeleton::Create(ThreeJoints()).value();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(sorted.source_index()[i], i);
}

TEST(Skeleton, FindsByName) {
  const Skeleton skeleton = Skeleton::Create(ThreeJoints()).value();
  EXPECT_EQ(skeleton.Find("middle"), 1);
  EXPECT_EQ(skeleton.Find("Middle"), kNoJoint);
  EXPECT_EQ(skeleton.Find(""), kNoJoint);
  EXPECT_EQ(Skeleton().Find("root"), kNoJoint);
}

TEST(Skeleton, KnowsAncestors) {
  const Skeleton body = MakeBody();
  const auto is_ancestor = [&](const char* a, const char* b) {
    return body.IsAncestor(body.Find(a), body.Find(b));
  };
  EXPECT_TRUE(is_ancestor("hips", "foot_l"));
  EXPECT_TRUE(is_ancestor("head", "head"));
  EXPECT_FALSE(is_ancestor("foot_l", "hips"));
  EXPECT_FALSE(is_ancestor("thigh_l", "foot_r"));
  EXPECT_FALSE(body.IsAncestor(kNoJoint, kNoJoint));
}

TEST(Skeleton, DerivesTails) {
  std::vector<JointDesc> joints = ThreeJoints();
  joints.push_back(joints[2]);
  joints[3].name = "leaf2";
  joints[3].rest.translation = {-1.0f, 4.0f, 0.0f};
  joints[3].rest.rotation = glm::angleAxis(glm::radians(90.0f), glm::vec3(0.0f, 0.0f, 1.0f));
  const Skeleton skeleton = Skeleton::Create(joints).value();
  EXPECT_EQ(skeleton.tails()[1], glm::vec3(0.0f, 2.0f, 0.0f));  // mean of (1,0,0) and (-1,4,0)
  EXPECT_EQ(skeleton.tails()[2], glm::vec3(1.0f, 0.0f, 0.0f));  // own offset carried on
  // (-1, 4, 0) of the parent's axes, seen from a joint that is turned by +90 degrees about z.
  EXPECT_NEAR(glm::distance(skeleton.tails()[3], glm::vec3(4.0f, 1.0f, 0.0f)), 0.0f, 1e-5f);
  joints[1].tail = glm::vec3(7.0f, 0.0f, 0.0f);
  EXPECT_EQ(Skeleton::Create(joints)->tails()[1], glm::vec3(7.0f, 0.0f, 0.0f));
}

TEST(Skeleton, RestModelFollowsTheDrawing) {
  const Skeleton plain = MakeBody();
  const Skeleton framed = MakeBody(7);
  for (int i = 0; i < plain.num_joints(); ++i) {
    const glm::vec3 a(plain.rest_model()[i][3]);
    const glm::vec3 b(framed.rest_model()[i][3]);
    EXPECT_LT(glm::distance(a, b), 1e-5f) << plain.joint_names()[i];
  }
}

TEST(SkeletonHash, TellsSkeletonsApartByAnyOfItsParts) {
  const std::uint64_t base = Skeleton::Create(ThreeJoints())->hash();
  EXPECT_EQ(base, Skeleton::Create(ThreeJoints())->hash());
  std::vector<JointDesc> joints = ThreeJoints();
  joints[2].name = "leag";
  EXPECT_NE(base, Skeleton::Create(joints)->hash());
  joints = ThreeJoints();
  joints[2].parent = 0;
  EXPECT_NE(base, Skeleton::Create(joints)->hash());
  joints = ThreeJoints();
  joints[2].rest.translation.x = 1.0000001f;
  EXPECT_NE(base, Skeleton::Create(joints)->hash());
  joints = ThreeJoints();
  joints[2].tail = glm::vec3(3.0f);
  EXPECT_NE(base, Skeleton::Create(joints)->hash());
}

TEST(SkeletonHash, CountsMinusZeroAsZero) {
  std::vector<JointDesc> joints = ThreeJoints();
  joints[0].rest.translation.x = -0.0f;
  EXPECT_EQ(Skeleton::Create(joints)->hash(), Skeleton::Create(ThreeJoints())->hash());
}

TEST(SkeletonHash, IsFnv1a) {
  // One joint "a" without parent, identity rest, no extent: the 64-bit FNV-1a of the 61 bytes that
  // the header lists, worked out apart from the code (Python, struct.pack little-endian).
  std::vector<JointDesc> joints(1);
  joints[0].name = "a";
  EXPECT_EQ(Skeleton::Create(joints)->hash(), 0x11cb6d3ba903297fu);
}

}  // namespace
}  // namespace furrow::wrinkle
