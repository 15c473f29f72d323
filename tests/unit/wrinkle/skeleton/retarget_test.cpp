// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/retarget.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/wrinkle/humanoid.h"
#include "tests/unit/wrinkle/test_characters.h"

namespace furrow::wrinkle {
namespace {

std::vector<glm::mat4> ModelOf(const Skeleton& skeleton, std::span<const Transform> local) {
  std::vector<glm::mat4> model(static_cast<std::size_t>(skeleton.num_joints()));
  EXPECT_EQ((LocalToModelJob{.skeleton = &skeleton, .local = local, .model = model}).Run(),
            JobStatus::kOk);
  return model;
}

std::vector<Transform> Carried(const Retarget& retarget, const Skeleton& target,
                               const LocalPose& pose) {
  std::vector<Transform> result(static_cast<std::size_t>(target.num_joints()));
  EXPECT_EQ(retarget.Run(pose.joints, result), JobStatus::kOk);
  return result;
}

TEST(Retarget, ToTheSameSkeletonChangesNothing) {
  std::mt19937 random(1);
  const Skeleton body = MakeBody(5);
  const Retarget retarget = Retarget::Create(body, body);
  EXPECT_TRUE(retarget.unmatched_source().empty());
  LocalPose pose;
  RandomPose(body, &random, &pose);
  pose.joints[3].scale = {1.0f, 2.0f, 0.5f};
  const std::vector<Transform> result = Carried(retarget, body, pose);
  for (std::size_t i = 0; i < result.size(); ++i) {
    EXPECT_LT(glm::distance(result[i].translation, pose.joints[i].translation), 1e-5f);
    EXPECT_GT(std::abs(glm::dot(result[i].rotation, pose.joints[i].rotation)), 1.0f - 1e-5f);
    EXPECT_LT(glm::distance(result[i].scale, pose.joints[i].scale), 1e-4f);
  }
}

// The same shape with other local frames, twice as large:
// the same motion in model space, twice as far.
TEST(Retarget, GivesTheSameModelSpaceMotionWhateverTheLocalFrames) {
  std::mt19937 random(2);
  const Skeleton source = MakeBody(11);
  const Skeleton target = MakeBody(12, 2.0f);
  const Retarget retarget = Retarget::Create(source, target);
  for (int round = 0; round < 20; ++round) {
    LocalPose pose;
    RandomPose(source, &random, &pose);
    const std::vector<glm::mat4> from = ModelOf(source, pose.joints);
    const std::vector<glm::mat4> to = ModelOf(target, Carried(retarget, target, pose));
    for (int i = 0; i < source.num_joints(); ++i) {
      const glm::vec3 expected = 2.0f * glm::vec3(from[i][3]);
      EXPECT_LT(glm::distance(glm::vec3(to[i][3]), expected), 1e-4f) << source.joint_names()[i];
    }
  }
}

TEST(Retarget, RestsWhatTheSourceLacksAndNamesWhatTheTargetLacks) {
  const Skeleton source = MakeSkeleton({{"hips", "", {}, {}}, {"tail", "hips", {0, 0, -1}, {}}});
  const Skeleton target = MakeBody(4);
  const Retarget retarget = Retarget::Create(source, target);
  ASSERT_EQ(retarget.unmatched_source().size(), 1u);
  EXPECT_EQ(retarget.unmatched_source()[0], "tail");
  const std::vector<Transform> result = Carried(retarget, target, RestPose(source));
  for (std::size_t i = 0; i < result.size(); ++i) {
    EXPECT_LT(glm::distance(result[i].translation, target.rest_pose()[i].translation), 1e-6f);
  }
}

TEST(Retarget, TriesAliasesBeforeEqualNames) {
  const Skeleton source = MakeSkeleton(
      {{"hips", "", {}, {}}, {"Neck", "hips", {0, 1, 0}, {}}, {"neck", "hips", {0, 1, 0}, {}}});
  const Skeleton target = MakeSkeleton({{"hips", "", {}, {}}, {"neck", "hips", {0, 1, 0}, {}}});
  const std::vector<std::pair<std::string, std::string>> aliases = {{"nobody", "neck"},
                                                                    {"Neck", "neck"}};
  const Retarget retarget = Retarget::Create(source, target, aliases);
  LocalPose pose = RestPose(source);
  Turn(source, "Neck", AngleAxis(40.0f, {0, 0, 1}), &pose);
  const std::vector<Transform> result = Carried(retarget, target, pose);
  EXPECT_NEAR(glm::degrees(glm::angle(result[1].rotation)), 40.0f, 1e-3f);
  ASSERT_EQ(retarget.unmatched_source().size(), 1u);
  EXPECT_EQ(retarget.unmatched_source()[0], "neck");
}

// A chain that only one of the two skeletons subdivides does not change the ratio of sizes.
TEST(Retarget, ComparesSizesOverSharedSpans) {
  const Skeleton source = MakeSkeleton({{"hips", "", {}, {}},
                                        {"spine1", "hips", {0, 0, 0.5f}, {}},
                                        {"chest", "spine1", {0, 1, 0}, {}}});
  const Skeleton target = MakeSkeleton({{"hips", "", {}, {}}, {"chest", "hips", {0, 3, 0}, {}}});
  LocalPose pose = RestPose(source);
  pose.joints[0].translation = {1.0f, 0.0f, 0.0f};
  const std::vector<Transform> result = Carried(Retarget::Create(source, target), target, pose);
  EXPECT_NEAR(result[0].translation.x, 3.0f, 1e-5f);
}

TEST(Retarget, CarriesUniformScaleExactlyAndQuarterTurnsByAxis) {
  const Skeleton source = MakeSkeleton({{"a", "", {}, {}}, {"b", "a", {0, 1, 0}, {}}});
  std::vector<JointDesc> joints(2);
  joints[0].name = "a";
  joints[0].rest.rotation = AngleAxis(90.0f, {0, 0, 1});
  joints[1].name = "b";
  joints[1].parent = 0;
  joints[1].rest.translation = {1.0f, 0.0f, 0.0f};
  const Skeleton target = Skeleton::Create(joints).value();
  LocalPose pose = RestPose(source);
  pose.joints[0].scale = {3.0f, 1.0f, 2.0f};
  const Transform result = Carried(Retarget::Create(source, target), target, pose)[0];
  // The target's x is the source's y, its y the source's -x.
  EXPECT_LT(glm::distance(result.scale, glm::vec3(1.0f, 3.0f, 2.0f)), 1e-5f);
}

TEST(Retarget, RefusesShortSpansAndWhatIsNotFinite) {
  const Skeleton body = MakeBody();
  const Retarget retarget = Retarget::Create(body, body);
  LocalPose pose = RestPose(body);
  std::vector<Transform> out(pose.joints.size());
  const std::span<const Transform> in = pose.joints;
  EXPECT_EQ(retarget.Run(in.first(in.size() - 1), out), JobStatus::kSizeMismatch);
  EXPECT_EQ(retarget.Run(in, std::span(out).first(out.size() - 1)), JobStatus::kSizeMismatch);
  pose.joints[0].rotation.z = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(retarget.Run(pose.joints, out), JobStatus::kNonFinite);
}

TEST(SkeletonSize, SumsBonesOverSharedJoints) {
  const Skeleton a = MakeSkeleton(
      {{"r", "", {5, 5, 5}, {}}, {"x", "r", {5, 7, 5}, {}}, {"y", "x", {5, 7, 8}, {}}});
  const Skeleton b = MakeSkeleton({{"r", "", {}, {}}, {"x", "r", {0, 1, 0}, {}}});
  EXPECT_FLOAT_EQ(SkeletonSize(a), 5.0f);
  EXPECT_FLOAT_EQ(SkeletonSize(a, &b), 2.0f);
  EXPECT_FLOAT_EQ(SkeletonSize(b, &a), 1.0f);
}

TEST(SkeletonSize, IsNotZeroWhileThereIsExtent) {
  const Skeleton a = MakeSkeleton({{"r", "", {}, glm::vec3(0, 2, 0)}});
  EXPECT_FLOAT_EQ(SkeletonSize(a), 2.0f);
  const Skeleton b = MakeSkeleton({{"q", "", {}, {}}, {"x", "q", {0, 1, 0}, {}}});
  EXPECT_FLOAT_EQ(SkeletonSize(b, &a), 1.0f);  // nothing shared: all of its own
}

TEST(RestStance, TurnsAnyAxesToFurrows) {
  const glm::vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const glm::vec3& axis : axes) {
    for (const float degrees : {0.0f, 90.0f, 180.0f, 270.0f, 20.0f}) {
      Humanoid body = MakeHumanoid();
      const glm::quat turn = glm::angleAxis(glm::radians(degrees), axis);
      body.Transform(turn, 1.0f, glm::vec3(1.0f, 2.0f, 3.0f));
      const auto stance = FindRestStance(body.Build(), body.Roles());
      ASSERT_TRUE(stance.has_value());
      EXPECT_FALSE(stance->toes_point_back);
      // A turn of 20 degrees is a stance, and not other axes.
      const glm::quat left = degrees == 20.0f ? stance->turn : stance->turn * turn;
      EXPECT_NEAR(std::abs(left.w), 1.0f, 1e-4f) << degrees;
    }
  }
}

// A body with the roles of a person whose trunk is level and whose arms are front legs.
Humanoid OnFourLegs() {
  Humanoid body = MakeHumanoid();
  body.Turn("spine", 90.0f, glm::vec3(1.0f, 0.0f, 0.0f));
  body.Turn("leftUpperArm", -90.0f, glm::vec3(0.0f, 0.0f, 1.0f));
  body.Turn("rightUpperArm", 90.0f, glm::vec3(0.0f, 0.0f, 1.0f));
  return body;
}

TEST(RestStance, FourLegsAreNotStoodUpright) {
  for (const float degrees : {0.0f, 90.0f, 180.0f, 270.0f}) {
    Humanoid body = OnFourLegs();
    const glm::quat turn = glm::angleAxis(glm::radians(degrees), glm::vec3(1, 0, 0));
    body.Transform(turn, 1.0f, glm::vec3(0.0f));
    const auto stance = FindRestStance(body.Build(), body.Roles());
    ASSERT_TRUE(stance.has_value());
    EXPECT_FALSE(stance->is_folded);
    EXPECT_NEAR(std::abs((stance->turn * turn).w), 1.0f, 1e-4f) << degrees;
  }
}

TEST(UpFromLimbs, NeedsFourLimbsThatPointOneWay) {
  const Humanoid fox = OnFourLegs();
  const auto up = UpFromLimbs(fox.Build(), fox.Roles());
  ASSERT_TRUE(up.has_value());
  EXPECT_GT(up->y, 0.95f);
  Humanoid tripod = OnFourLegs();
  tripod.Remove("leftHand");
  EXPECT_FALSE(UpFromLimbs(tripod.Build(), tripod.Roles()));
  const Humanoid person = MakeHumanoid();  // in a T-pose
  EXPECT_FALSE(UpFromLimbs(person.Build(), person.Roles()));
  EXPECT_FALSE(UpFromLimbs(Skeleton(), {}));
}

// LaFAN1's files rest with all bones along +X.
TEST(RestStance, ABodyOnOneLineIsFolded) {
  Humanoid body = MakeHumanoid();
  for (const char* leg : {"leftUpperLeg", "rightUpperLeg"}) {
    body.Turn(leg, 180.0f, glm::vec3(1.0f, 0.0f, 0.0f));
  }
  body.Transform(glm::angleAxis(glm::radians(-90.0f), glm::vec3(0, 0, 1)), 1.0f, glm::vec3(0.0f));
  const auto stance = FindRestStance(body.Build(), body.Roles());
  ASSERT_TRUE(stance.has_value());
  EXPECT_TRUE(stance->is_folded);
  EXPECT_EQ(stance->turn, glm::quat(1.0f, 0.0f, 0.0f, 0.0f));
}

// The files of Bandai Namco rest with one leg along the trunk and the other against it.
TEST(RestStance, ABodyWithOneLegUpIsFolded) {
  for (const char* leg : {"leftUpperLeg", "rightUpperLeg"}) {
    Humanoid body = MakeHumanoid();
    body.Turn(leg, 180.0f, glm::vec3(1.0f, 0.0f, 0.0f));
    const auto stance = FindRestStance(body.Build(), body.Roles());
    ASSERT_TRUE(stance.has_value());
    EXPECT_TRUE(stance->is_folded) << leg;
  }
}

TEST(RestStance, ToesTellThatSidesAreExchanged) {
  Humanoid body = MakeHumanoid();
  JointRoles roles = body.Roles();
  for (JointRole& role : roles) role = MirrorOf(role);
  const auto stance = FindRestStance(body.Build(), roles);
  ASSERT_TRUE(stance.has_value());
  EXPECT_TRUE(stance->toes_point_back);
}

TEST(RestStance, IsUnknownWithoutATrunkOrSides) {
  const Humanoid body = MakeHumanoid();
  EXPECT_FALSE(FindRestStance(body.Build(), JointRoles(body.joints.size(), JointRole::kNone)));
  EXPECT_FALSE(FindRestStance(Skeleton(), {}));
}

}  // namespace
}  // namespace furrow::wrinkle
