// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/body_retarget.h"

#include <gtest/gtest.h>

#include "tests/unit/allocation_counter.h"
#include "tests/unit/wrinkle/humanoid.h"
#include "wrinkle/skeleton/retarget.h"

namespace furrow::wrinkle {
namespace {

// One body carried to another, with the places of joints to compare.
class Carrier {
 public:
  Carrier(const Humanoid& source, const Humanoid& target, unsigned source_seed = 0,
          unsigned target_seed = 0)
      : source_(source.Build(source_seed)),
        target_(target.Build(target_seed)),
        source_roles_(source.Roles()),
        target_roles_(target.Roles()),
        retarget_(Retarget::Create(source_, source_roles_, target_, target_roles_)) {
    EXPECT_TRUE(retarget_.by_role());
  }

  void Run(const LocalPose& pose) {
    from_.resize(static_cast<std::size_t>(source_.num_joints()));
    to_.resize(static_cast<std::size_t>(target_.num_joints()));
    local_.resize(to_.size());
    const std::uint64_t allocations = furrow::test::NumAllocations();
    ASSERT_EQ(retarget_.Run(pose.joints, local_), JobStatus::kOk);
    EXPECT_EQ(furrow::test::NumAllocations(), allocations);
    ASSERT_EQ((LocalToModelJob{&source_, pose.joints, from_}).Run(), JobStatus::kOk);
    ASSERT_EQ((LocalToModelJob{&target_, local_, to_}).Run(), JobStatus::kOk);
  }

  glm::vec3 From(JointRole role) const {
    return glm::vec3(from_[Body(source_, source_roles_).First(role)][3]);
  }
  glm::vec3 To(JointRole role) const {
    return glm::vec3(to_[Body(target_, target_roles_).First(role)][3]);
  }
  // The angle in degrees between the source's and the target's bone.
  float Apart(JointRole role, const glm::quat& turn = {1.0f, 0.0f, 0.0f, 0.0f}) const {
    const glm::vec3 a = glm::normalize(turn * (From(BoneEnd(role)) - From(role)));
    const glm::vec3 b = glm::normalize(To(BoneEnd(role)) - To(role));
    return glm::degrees(2.0f * std::asin(0.5f * glm::distance(a, b)));
  }

  const Skeleton& source() const { return source_; }
  const Skeleton& target() const { return target_; }
  const std::vector<Transform>& local() const { return local_; }
  const Retarget& retarget() const { return retarget_; }
  // Of a joint of the target, model space: its turn away from rest where no frames are random.
  glm::quat Rotation(const std::string& name) const {
    return glm::quat_cast(to_[target_.Find(name)]);
  }

 private:
  Skeleton source_;
  Skeleton target_;
  JointRoles source_roles_;
  JointRoles target_roles_;
  Retarget retarget_;
  std::vector<Transform> local_;
  std::vector<glm::mat4> from_;
  std::vector<glm::mat4> to_;
};

LocalPose RandomTurns(const Skeleton& skeleton, std::mt19937* random) {
  LocalPose pose;
  pose.SetRest(skeleton);
  for (Transform& joint : pose.joints) joint.rotation = RandomRotation(random);
  return pose;
}

// Every role with a bone in both bodies.
std::vector<JointRole> Bones(const Humanoid& a, const Humanoid& b) {
  std::vector<JointRole> bones;
  const auto has = [](const Humanoid& body, JointRole role) {
    const JointRoles roles = body.Roles();
    return std::find(roles.begin(), roles.end(), role) != roles.end();
  };
  for (int i = 1; i < kNumJointRoles; ++i) {
    const auto role = static_cast<JointRole>(i);
    const JointRole end = BoneEnd(role);
    if (end == JointRole::kNone) continue;
    if (has(a, role) && has(a, end) && has(b, role) && has(b, end)) bones.push_back(role);
  }
  return bones;
}

void ExpectSamePose(const std::vector<Transform>& a, const std::vector<Transform>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT(glm::distance(a[i].translation, b[i].translation), 2e-5f) << i;
    EXPECT_GT(std::abs(glm::dot(a[i].rotation, b[i].rotation)), 1.0f - 1e-5f) << i;
    EXPECT_LT(glm::distance(a[i].scale, b[i].scale), 1e-4f) << i;
  }
}

// A T-pose with the arms lowered, the legs apart, bent fingers and a toe-out.
Humanoid InAPose() {
  Humanoid body = MakeHumanoid();
  for (const auto& [side, sign] : {std::pair("left", 1.0f), std::pair("right", -1.0f)}) {
    const std::string name = side;
    body.Turn(name + "UpperArm", -50.0f * sign, {0, 0, 1});
    body.Turn(name + "LowerArm", -20.0f * sign, {0, 1, 0});
    body.Turn(name + "IndexProximal", -25.0f * sign, {0, 0, 1});
    body.Turn(name + "ThumbProximal", 20.0f * sign, {0, 1, 0});
    body.Turn(name + "UpperLeg", 15.0f * sign, {0, 0, 1});
    body.Turn(name + "LowerLeg", -15.0f * sign, {0, 0, 1});
    body.Turn(name + "Foot", 12.0f * sign, {0, 1, 0});
  }
  return body;
}

TEST(BodyRetarget, ToTheSameBodyChangesNothing) {
  std::mt19937 random(1);
  Carrier carrier(MakeHumanoid(), MakeHumanoid(), 3, 3);
  for (int round = 0; round < 10; ++round) {
    LocalPose pose;
    RandomPose(carrier.source(), &random, &pose);
    pose.joints[4].scale = {1.5f, 1.5f, 1.5f};
    carrier.Run(pose);
    ExpectSamePose(carrier.local(), pose.joints);
  }
  EXPECT_TRUE(carrier.retarget().unmatched_source().empty());
}

TEST(BodyRetarget, ToTheSameBodyOfSeveralJointsALimbChangesNothing) {
  std::mt19937 random(9);
  Humanoid body = MakeHumanoid();
  body.Split("leftUpperArm", "leftLowerArm", 0.5f);
  body.Split("spine", "chest", 0.3f);
  Carrier carrier(body, body, 3, 3);
  LocalPose pose;
  RandomPose(carrier.source(), &random, &pose);
  carrier.Run(pose);
  ExpectSamePose(carrier.local(), pose.joints);
}

TEST(BodyRetarget, ToTheSameBodyUnderOtherNamesChangesNothing) {
  std::mt19937 random(2);
  Humanoid renamed = MakeHumanoid();
  renamed.Prefix("mixamorig:");
  Carrier carrier(MakeHumanoid(), renamed, 4, 4);
  LocalPose pose;
  RandomPose(carrier.source(), &random, &pose);
  carrier.Run(pose);
  ExpectSamePose(carrier.local(), pose.joints);
}

TEST(BodyRetarget, RestPosesInAnotherStanceGiveTheSameDirections) {
  std::mt19937 random(3);
  const Humanoid t_pose = MakeHumanoid();
  const Humanoid a_pose = InAPose();
  const std::vector<JointRole> bones = Bones(t_pose, a_pose);
  EXPECT_EQ(bones.size(), 22u);
  for (const bool forth : {true, false}) {
    Carrier carrier(forth ? t_pose : a_pose, forth ? a_pose : t_pose, 5, 6);
    for (int round = 0; round < 20; ++round) {
      carrier.Run(RandomTurns(carrier.source(), &random));
      for (const JointRole bone : bones) {
        EXPECT_LT(carrier.Apart(bone), glm::degrees(1e-4f)) << ToString(bone);
      }
    }
  }
}

// Joints below a hand turn with it, whatever the palm's direction at rest.
TEST(BodyRetarget, PalmsFaceTheSameWay) {
  Humanoid supine = MakeHumanoid();
  supine.Turn("leftHand", 90.0f, {1, 0, 0});  // palm forward at rest
  Carrier carrier(MakeHumanoid(), supine, 0, 7);
  LocalPose pose;
  pose.SetRest(carrier.source());
  Turn(carrier.source(), "leftLowerArm", AngleAxis(70.0f, {0, 1, 0}), &pose);
  carrier.Run(pose);
  const auto across = [](const glm::vec3& index, const glm::vec3& little) {
    return glm::normalize(index - little);
  };
  using enum JointRole;
  EXPECT_LT(
      glm::distance(across(carrier.From(kLeftIndexProximal), carrier.From(kLeftLittleProximal)),
                    across(carrier.To(kLeftIndexProximal), carrier.To(kLeftLittleProximal))),
      1e-4f);
}

TEST(BodyRetarget, FeetStayFlatHoweverDeepTheToesLie) {
  Humanoid high_heels = MakeHumanoid();
  high_heels.Turn("leftFoot", 25.0f, {1, 0, 0});
  Carrier carrier(MakeHumanoid(), high_heels);
  LocalPose pose;
  pose.SetRest(carrier.source());
  carrier.Run(pose);
  const glm::vec3 up(0.0f, 1.0f, 0.0f);
  EXPECT_GT(glm::dot(carrier.Rotation("leftFoot") * up, up), 0.99999f);
}

TEST(BodyRetarget, HipsTravelAsFarAsLegsAreLongAndStandOnTheFloor) {
  Humanoid giant = MakeHumanoid();
  giant.Transform(AngleAxis(0.0f, {0, 1, 0}), 2.5f, glm::vec3(0.0f));
  Carrier carrier(MakeHumanoid(), giant, 0, 8);
  LocalPose pose;
  pose.SetRest(carrier.source());
  pose.joints[0].translation += glm::vec3(0.4f, -0.3f, 1.0f);
  carrier.Run(pose);
  EXPECT_LT(glm::distance(carrier.To(JointRole::kHips), glm::vec3(1.0f, 1.625f, 2.5f)), 1e-4f);
  for (int i = 1; i < carrier.target().num_joints(); ++i) {
    EXPECT_LT(
        glm::distance(carrier.local()[i].translation, carrier.target().rest_pose()[i].translation),
        1e-5f);
  }
}

// A BVH file's root rests at the origin; only its motion states the position.
TEST(BodyRetarget, ASourceThatRestsAtTheOriginIsPutOnTheFloor) {
  Humanoid bvh = MakeHumanoid();
  bvh.Transform(AngleAxis(0.0f, {0, 1, 0}), 20.0f, {0.0f, -19.0f, 0.0f});
  Carrier carrier(bvh, MakeHumanoid());
  LocalPose pose;
  pose.SetRest(carrier.source());
  carrier.Run(pose);  // no place at all: where the target rests
  EXPECT_LT(glm::distance(carrier.To(JointRole::kHips), glm::vec3(0.0f, 0.95f, 0.0f)), 1e-5f);
  const glm::vec3 rest = pose.joints[0].translation;
  pose.joints[0].translation = rest + glm::vec3(1e-4f, -1e-4f, 0.0f);  // rounding, not a position
  carrier.Run(pose);
  EXPECT_LT(glm::distance(carrier.To(JointRole::kHips), glm::vec3(0.0f, 0.95f, 0.0f)), 1e-5f);
  pose.joints[0].translation = rest + glm::vec3(0.0f, 0.02f, 0.0f);  // this is: under the floor
  carrier.Run(pose);
  EXPECT_LT(carrier.To(JointRole::kHips).y, 0.1f);
  pose.joints[0].translation = {10.0f, 18.0f, 0.0f};
  carrier.Run(pose);
  EXPECT_LT(glm::distance(carrier.To(JointRole::kHips), glm::vec3(0.5f, 0.9f, 0.0f)), 1e-4f);
}

TEST(BodyRetarget, ASourceThatLiesOnItsBackIsStoodUp) {
  std::mt19937 random(4);
  const glm::quat lying = AngleAxis(90.0f, {1, 0, 0}) * AngleAxis(90.0f, {0, 1, 0});
  Humanoid z_up = MakeHumanoid();
  z_up.Transform(lying, 100.0f, glm::vec3(0.0f));
  Carrier carrier(z_up, InAPose(), 9, 10);
  for (int round = 0; round < 5; ++round) {
    carrier.Run(RandomTurns(carrier.source(), &random));
    for (const JointRole bone : Bones(z_up, InAPose())) {
      EXPECT_LT(carrier.Apart(bone, glm::conjugate(lying)), 0.02f) << ToString(bone);
    }
  }
}

TEST(BodyRetarget, ChainsOfUnlikeCountsShareTheBendAndEndAlike) {
  Humanoid few = MakeHumanoid();
  few.Remove("upperChest");
  few.Remove("chest");
  Humanoid many = MakeHumanoid();
  many.Split("neck", "head", 0.5f);
  for (const bool forth : {true, false}) {
    Carrier carrier(forth ? few : many, forth ? many : few);
    LocalPose pose;
    pose.SetRest(carrier.source());
    const glm::quat bend = AngleAxis(60.0f, {0, 0, 1});
    Turn(carrier.source(), "spine", bend, &pose);
    Turn(carrier.source(), "head", bend, &pose);
    carrier.Run(pose);
    EXPECT_TRUE(carrier.retarget().unmatched_source().empty());
    const auto degrees = [&](const char* joint) {
      return glm::degrees(glm::angle(carrier.Rotation(joint)));
    };
    EXPECT_NEAR(degrees("leftUpperArm"), 60.0f, 0.01f);
    EXPECT_NEAR(degrees("head"), 120.0f, 0.01f);
    if (forth) {
      EXPECT_NEAR(degrees("spine"), 20.0f, 0.01f);
      EXPECT_NEAR(degrees("chest"), 40.0f, 0.01f);
      EXPECT_NEAR(degrees("upperChest"), 60.0f, 0.01f);
      EXPECT_NEAR(degrees("neck"), 60.0f, 0.01f);
      EXPECT_NEAR(degrees("neck2"), 80.0f, 0.01f);
    } else {
      EXPECT_NEAR(degrees("spine"), 60.0f, 0.01f);
    }
  }
}

// A limb of two joints: the whole swing at its head, the twist growing along it.
TEST(BodyRetarget, ALimbOfSeveralJointsSharesTheTwistAlone) {
  Humanoid split = MakeHumanoid();
  split.Split("leftUpperArm", "leftLowerArm", 0.5f);
  Carrier carrier(MakeHumanoid(), split, 0, 0);
  LocalPose pose;
  pose.SetRest(carrier.source());
  const glm::quat swing = AngleAxis(-70.0f, {0, 0, 1});
  Turn(carrier.source(), "leftUpperArm", swing * AngleAxis(40.0f, {1, 0, 0}), &pose);
  carrier.Run(pose);
  EXPECT_LT(carrier.Apart(JointRole::kLeftUpperArm), 0.02f);
  const auto expect = [&](const char* joint, float twist) {
    const glm::quat expected = swing * AngleAxis(twist, {1, 0, 0});
    EXPECT_GT(std::abs(glm::dot(carrier.Rotation(joint), expected)), 0.99999f) << joint;
  };
  expect("leftUpperArm", 20.0f);
  expect("leftUpperArm2", 40.0f);
  expect("leftLowerArm", 40.0f);
}

TEST(BodyRetarget, ABoneThatBendsInsideKeepsItsWholeDirection) {
  std::mt19937 random(5);
  Humanoid source = MakeHumanoid();
  source.Split("leftLowerLeg", "leftFoot", 0.4f);
  source.Split("rightUpperArm", "rightLowerArm", 0.6f);
  for (Humanoid::Joint& joint : source.joints) {
    if (joint.place.name == "rightUpperArm2") joint.role = JointRole::kNone;  // nobody knows it
  }
  Carrier carrier(source, InAPose(), 11, 12);
  for (int round = 0; round < 10; ++round) {
    carrier.Run(RandomTurns(carrier.source(), &random));
    EXPECT_LT(carrier.Apart(JointRole::kLeftLowerLeg), 0.02f);
    EXPECT_LT(carrier.Apart(JointRole::kRightUpperArm), 0.02f);
  }
}

TEST(BodyRetarget, WhatTheSourceLacksFollowsWhatItHangsFrom) {
  std::mt19937 random(6);
  Humanoid bare = MakeHumanoid();
  for (const char* side : {"left", "right"}) {
    for (const char* joint : {"Shoulder", "Toes", "ThumbDistal", "LittleIntermediate"}) {
      bare.Remove(side + std::string(joint));
    }
  }
  bare.Remove("neck");
  const Humanoid whole = InAPose();
  Carrier carrier(bare, whole, 13, 14);
  const LocalPose pose = RandomTurns(carrier.source(), &random);
  carrier.Run(pose);
  for (const JointRole bone : Bones(bare, whole)) {
    if (bone == JointRole::kLeftFoot || bone == JointRole::kRightFoot) continue;
    EXPECT_LT(carrier.Apart(bone), 0.02f) << ToString(bone);
  }
  for (const char* joint : {"leftShoulder", "rightToes", "leftThumbDistal"}) {
    const int i = carrier.target().Find(joint);
    EXPECT_GT(
        std::abs(glm::dot(carrier.local()[i].rotation, carrier.target().rest_pose()[i].rotation)),
        0.99999f)
        << joint;
  }
}

// Joints without a role still go by name, below what goes by role.
TEST(BodyRetarget, FacesAreCarriedByName) {
  std::mt19937 random(7);
  Humanoid source = MakeHumanoid();
  source.joints.push_back({JointRole::kNone, {"brow", "head", {0.03f, 1.65f, 0.1f}, {}}});
  source.joints.push_back({JointRole::kNone, {"tail", "hips", {0, 0.9f, -0.1f}, {}}});
  Humanoid target = InAPose();
  target.joints.push_back({JointRole::kNone, {"brow", "head", {0.03f, 1.65f, 0.1f}, {}}});
  Carrier carrier(source, target, 15, 16);
  ASSERT_EQ(carrier.retarget().unmatched_source().size(), 1u);
  EXPECT_EQ(carrier.retarget().unmatched_source()[0], "tail");
  LocalPose pose;
  pose.SetRest(carrier.source());
  Move(carrier.source(), "brow", {0.0f, 0.01f, 0.0f}, &pose);
  carrier.Run(pose);
  const glm::vec3 expected(0.03f, 1.66f, 0.1f);
  std::vector<glm::mat4> model(carrier.local().size());
  ASSERT_EQ((LocalToModelJob{&carrier.target(), carrier.local(), model}).Run(), JobStatus::kOk);
  EXPECT_LT(glm::distance(glm::vec3(model[carrier.target().Find("brow")][3]), expected), 1e-4f);
}

TEST(BodyRetarget, RolesThatFitNoSkeletonAreLeftOut) {
  const Humanoid body = MakeHumanoid();
  const Skeleton skeleton = body.Build();
  JointRoles roles = body.Roles();
  EXPECT_FALSE(Retarget::Create(skeleton, {}, skeleton, roles).by_role());
  EXPECT_FALSE(Retarget::Create(skeleton, roles, skeleton, {}).by_role());
  roles.pop_back();
  EXPECT_FALSE(Retarget::Create(skeleton, roles, skeleton, roles).by_role());
}

TEST(BodyRetarget, SwingTakesOneDirectionToAnother) {
  std::mt19937 random(8);
  for (int round = 0; round < 100; ++round) {
    const glm::vec3 a = RandomVector(&random, 2.0f);
    const glm::vec3 b = round % 3 == 0 ? -a : RandomVector(&random, 1.0f);
    EXPECT_LT(glm::distance(Swing(a, b) * glm::normalize(a), glm::normalize(b)), 2e-3f);
  }
}

}  // namespace
}  // namespace furrow::wrinkle
