// SPDX-License-Identifier: Apache-2.0
#include "rig/rig_reference_pose.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace furrow::rig {
namespace {

using wrinkle::PoseFrame;

constexpr float kPi = 3.14159265f;

glm::quat Turn(float degrees, glm::vec3 axis) {
  return glm::angleAxis(degrees * kPi / 180.0f, axis);
}

// A root that is turned by 90 degrees about Z at rest, and a child at 1 unit along the root's X
// axis.
PoseFrame TurnedRoot() {
  PoseFrame frame;
  frame.skeleton =
      *wrinkle::Skeleton::Create({{"root", -1, {glm::vec3(0), Turn(90, {0, 0, 1})}, {}},
                                  {"child", 0, {glm::vec3(1, 0, 0)}, glm::vec3(1, 0, 0)}});
  frame.pose.SetRest(frame.skeleton);
  return frame;
}

TEST(RigReferencePose, RestPoseMovesNoJoints) {
  const auto pose = ReferencePoseFromFrame("rest", TurnedRoot());
  ASSERT_TRUE(pose.ok());
  EXPECT_TRUE(pose->joints.empty());
  EXPECT_GT(pose->source_size, 0.0f);
}

TEST(RigReferencePose, UsesModelAxes) {
  PoseFrame frame = TurnedRoot();
  // A turn about the child's X axis and a move along the root's X axis; both are the model's Y
  // axis.
  frame.pose.joints[1].rotation = Turn(30, {1, 0, 0});
  frame.pose.joints[1].translation += glm::vec3(0.25f, 0, 0);
  const auto pose = ReferencePoseFromFrame("p", frame);
  ASSERT_TRUE(pose.ok());
  ASSERT_EQ(pose->joints.size(), 1u);
  EXPECT_NEAR(pose->joints[0].rotation.y, std::sin(15.0f * kPi / 180.0f), 1e-6);
  EXPECT_NEAR(pose->joints[0].rotation.x, 0.0f, 1e-6);
  EXPECT_NEAR(pose->joints[0].translation.y, 0.25f, 1e-6);
  EXPECT_NEAR(pose->joints[0].translation.x, 0.0f, 1e-6);
}

TEST(RigReferencePose, AcceptsAnotherFrameAsRest) {
  PoseFrame rest = TurnedRoot();
  PoseFrame frame = TurnedRoot();
  rest.pose.joints[1].rotation = Turn(10, {0, 1, 0});
  frame.pose.joints[1].rotation = Turn(25, {0, 1, 0});
  const auto same = ReferencePoseFromFrame("p", rest, &rest);
  ASSERT_TRUE(same.ok());
  EXPECT_TRUE(same->joints.empty());
  const auto pose = ReferencePoseFromFrame("p", frame, &rest);
  ASSERT_TRUE(pose.ok());
  ASSERT_EQ(pose->joints.size(), 1u);
  EXPECT_NEAR(pose->joints[0].rotation.w, std::cos(7.5f * kPi / 180.0f), 1e-6);
}

TEST(RigReferencePose, RejectsPosesThatDoNotFitTheSkeleton) {
  PoseFrame frame = TurnedRoot();
  frame.pose.joints.pop_back();
  EXPECT_EQ(ReferencePoseFromFrame("p", frame).status().code(), StatusCode::kInvalidArgument);
  frame = TurnedRoot();
  frame.pose.joints[1].translation.x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(ReferencePoseFromFrame("p", frame).status().code(), StatusCode::kNonFinite);
}

TEST(RigReferencePose, MixesScaleRotationVectors) {
  wrinkle::ReferencePose a{"a", {{"j", Turn(40, {1, 0, 0}), {0, 0, 2}}}, 2.0f};
  wrinkle::ReferencePose b{
      "b", {{"j", -Turn(20, {1, 0, 0}), {0, 0, 1}}, {"k", Turn(9, {0, 1, 0}), {}}}, 4.0f};
  const WeightedPose parts[] = {{&a, 0.5f}, {&b, -2.0f}};
  const auto mix = MixReferencePoses("m", parts);
  EXPECT_EQ(mix.source_size, 2.0f);
  ASSERT_EQ(mix.joints.size(), 2u);
  // 40 * 0.5 - 20 * 2 = -20 degrees; the sign of a quaternion does not matter.
  EXPECT_NEAR(mix.joints[0].rotation.x, std::sin(-10.0f * kPi / 180.0f), 1e-6);
  EXPECT_NEAR(mix.joints[0].translation.z, 2.0f * 0.5f - 2.0f * 1.0f * (2.0f / 4.0f), 1e-6);
  EXPECT_NEAR(mix.joints[1].rotation.y, std::sin(-9.0f * kPi / 180.0f), 1e-6);
}

TEST(RigReferencePose, EulerAnglesTurnAboutFixedAxesInOrder) {
  const glm::vec3 v = FromEulerDegrees({90, 90, 0}) * glm::vec3(0, 1, 0);
  // X takes +Y to +Z, then Y takes +Z to +X.
  EXPECT_NEAR(v.x, 1.0f, 1e-6);
  EXPECT_NEAR(v.y, 0.0f, 1e-6);
  EXPECT_NEAR(v.z, 0.0f, 1e-6);
}

}  // namespace
}  // namespace furrow::rig
