// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/shapes/blend_shape_pose.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "wrinkle/skeleton/reference_pose.h"

namespace furrow::wrinkle {
namespace {

constexpr float kQuarter = 1.57079633f;

Skeleton FaceSkeleton() {
  std::vector<JointDesc> joints(3);
  joints[0].name = "head";
  // Its children's axes are not the model's.
  joints[0].rest.rotation = glm::angleAxis(kQuarter, glm::vec3(0, 1, 0));
  joints[1].name = "jaw";
  joints[1].parent = 0;
  joints[1].rest.translation = glm::vec3(0, -1, 0);
  joints[2].name = "brow_l";
  joints[2].parent = 0;
  joints[2].rest.translation = glm::vec3(1, 1, 0);
  Result<Skeleton> skeleton = Skeleton::Create(std::move(joints));
  EXPECT_TRUE(skeleton.ok());
  return std::move(skeleton).value();
}

Rig Poses() {
  Rig rig;
  ReferencePose open{.name = "jawOpen", .joints = {}};
  open.joints.push_back({.joint = "jaw", .rotation = glm::angleAxis(0.4f, glm::vec3(1, 0, 0))});
  open.joints.push_back({.joint = "chin_of_another", .translation = glm::vec3(1.0f)});
  ReferencePose up{.name = "browInnerUp", .joints = {}};
  up.joints.push_back({.joint = "brow_l", .translation = glm::vec3(0.0f, 0.2f, 0.1f)});
  rig.reference_poses = {open, up};
  return rig;
}

std::vector<Transform> Rest(const Skeleton& skeleton) {
  return {skeleton.rest_pose().begin(), skeleton.rest_pose().end()};
}

TEST(BlendShapePose, AtOneIsTheReferencePose) {
  const Skeleton skeleton = FaceSkeleton();
  const Rig rig = Poses();
  const std::vector<std::string> shapes = {"tongueOut", "JAWOPEN", "browInnerUp"};
  const BlendShapePose pose = BlendShapePose::Create(rig, skeleton, shapes);
  EXPECT_FALSE(pose.empty());
  std::vector<Transform> local = Rest(skeleton);
  ASSERT_EQ(pose.Run(std::vector<float>{1.0f, 1.0f, 1.0f}, local), JobStatus::kOk);
  std::vector<Transform> want = Rest(skeleton);
  for (const ReferencePose& reference : rig.reference_poses) {
    for (const JointDelta& delta : reference.joints) {
      const int joint = skeleton.Find(delta.joint);
      if (joint != kNoJoint) ApplyJointDelta(delta, skeleton, joint, 1.0f, &want[joint]);
    }
  }
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    EXPECT_LT(glm::distance(local[j].translation, want[j].translation), 1e-6f) << j;
    EXPECT_GT(std::abs(glm::dot(local[j].rotation, want[j].rotation)), 1.0f - 1e-6f) << j;
  }
  // The head is turned by a quarter: model z is its -x.
  EXPECT_NEAR(local[2].translation.x - 1.0f, -0.1f, 1e-6f);
}

TEST(BlendShapePose, HalfACoefficientIsHalfTheWay) {
  const Skeleton skeleton = FaceSkeleton();
  const BlendShapePose pose =
      BlendShapePose::Create(Poses(), skeleton, std::vector<std::string>{"jawOpen", "browInnerUp"});
  std::vector<Transform> local = Rest(skeleton);
  ASSERT_EQ(pose.Run(std::vector<float>{0.5f, 0.5f}, local), JobStatus::kOk);
  EXPECT_NEAR(2.0f * std::acos(std::abs(local[1].rotation.w)), 0.2f, 1e-4f);
  EXPECT_NEAR(local[2].translation.y, 1.1f, 1e-6f);
}

// Lips that close by more than the jaw opens would pass through each other.
TEST(BlendShapePose, TheMouthClosesNoFartherThanTheJawOpens) {
  const Skeleton skeleton = FaceSkeleton();
  Rig rig = Poses();
  ReferencePose close{.name = "mouthClose", .joints = {}};
  close.joints.push_back({.joint = "brow_l", .translation = glm::vec3(0.0f, 0.3f, 0.0f)});
  rig.reference_poses.push_back(close);
  const auto rise = [&](const std::vector<std::string>& names, const std::vector<float>& values) {
    std::vector<Transform> local = Rest(skeleton);
    EXPECT_EQ(BlendShapePose::Create(rig, skeleton, names).Run(values, local), JobStatus::kOk);
    return local[2].translation.y - 1.0f;
  };
  const std::vector<std::string> both = {"MouthClose", "JawOpen"};
  EXPECT_NEAR(rise(both, {1.0f, 0.0f}), 0.0f, 1e-6f);
  EXPECT_NEAR(rise(both, {1.0f, 0.4f}), 0.12f, 1e-6f);
  EXPECT_NEAR(rise(both, {0.3f, 1.0f}), 0.09f, 1e-6f);
  EXPECT_NEAR(rise(both, {1.0f, -0.5f}), 0.0f, 1e-6f);
  EXPECT_NEAR(rise(both, {1.0f}), 0.0f, 1e-6f);  // the jaw's coefficient is missing
  // A stream without the jaw's blend shape moves the jaw by its joint.
  EXPECT_NEAR(rise({"mouthClose"}, {1.0f}), 0.3f, 1e-6f);
}

TEST(BlendShapePose, CoefficientsThatAreNotThereCountAsZero) {
  const Skeleton skeleton = FaceSkeleton();
  const BlendShapePose pose =
      BlendShapePose::Create(Poses(), skeleton, std::vector<std::string>{"x", "jawOpen"});
  std::vector<Transform> local = Rest(skeleton);
  ASSERT_EQ(pose.Run(std::vector<float>{1.0f}, local), JobStatus::kOk);
  EXPECT_EQ(local[1].rotation, skeleton.rest_pose()[1].rotation);
}

TEST(BlendShapePose, NamesWithoutAPoseMoveNothing) {
  const Skeleton skeleton = FaceSkeleton();
  EXPECT_TRUE(BlendShapePose().empty());
  EXPECT_TRUE(
      BlendShapePose::Create(Poses(), skeleton, std::vector<std::string>{"cheekPuff"}).empty());
  std::vector<Transform> none;
  EXPECT_EQ(BlendShapePose().Run({}, none), JobStatus::kOk);
}

TEST(BlendShapePose, BadInputChangesNothing) {
  const Skeleton skeleton = FaceSkeleton();
  const BlendShapePose pose =
      BlendShapePose::Create(Poses(), skeleton, std::vector<std::string>{"browInnerUp"});
  std::vector<Transform> local = Rest(skeleton);
  const std::vector<float> nan = {std::numeric_limits<float>::quiet_NaN()};
  EXPECT_EQ(pose.Run(nan, local), JobStatus::kNonFinite);
  EXPECT_EQ(local[2].translation, skeleton.rest_pose()[2].translation);
  EXPECT_EQ(pose.Run(std::vector<float>{1.0f}, std::span(local).first(2)),
            JobStatus::kSizeMismatch);
}

}  // namespace
}  // namespace furrow::wrinkle
