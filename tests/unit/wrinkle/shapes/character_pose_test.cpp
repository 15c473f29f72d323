// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/shapes/character_pose.h"

#include <random>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/unit/wrinkle/test_characters.h"
#include "wrinkle/skeleton/reference_pose.h"

namespace furrow::wrinkle {
namespace {

// The body with a pose that lifts its left brow.
const JointDelta kLift{.joint = "brow_l", .translation = glm::vec3(0.0f, 0.02f, 0.0f)};

Rig BrowLift() {
  Rig rig;
  rig.reference_poses = {{.name = "browOuterUpLeft", .joints = {kLift}}};
  return rig;
}

const std::vector<std::string> kPoseShapes = {"browOuterUpLeft"};

// Where joint `name` is, by products of 4x4 matrices up its chain: another way than the job's.
glm::vec3 OriginOf(const Skeleton& skeleton, const std::vector<Transform>& local,
                   std::string_view name) {
  glm::vec4 point(0.0f, 0.0f, 0.0f, 1.0f);
  for (int joint = skeleton.Find(name); joint >= 0; joint = skeleton.joint_parents()[joint]) {
    const Transform& at = local[joint];
    glm::mat4 matrix = glm::mat4_cast(at.rotation);
    for (int axis = 0; axis < 3; ++axis) matrix[axis] *= at.scale[axis];
    matrix[3] = glm::vec4(at.translation, 1.0f);
    point = matrix * point;
  }
  return glm::vec3(point);
}

TEST(CharacterPose, CarriesThePoseOverAndPutsTheBlendShapesUponIt) {
  std::mt19937 random(3);
  const Skeleton source = MakeBody(7);
  const Skeleton target = MakeBody(8, 2.0f);
  const Retarget retarget = Retarget::Create(source, target);
  const BlendShapePose shapes = BlendShapePose::Create(BrowLift(), target, kPoseShapes);
  CharacterPose drawn(&target);
  for (int round = 0; round < 10; ++round) {
    LocalPose pose;
    RandomPose(source, &random, &pose);
    std::vector<Transform> local(target.num_joints());
    ASSERT_EQ(retarget.Run(pose.joints, local), JobStatus::kOk);
    const int brow = target.Find("brow_l");
    ApplyJointDelta(kLift, target, brow, 0.5f, &local[brow]);
    ASSERT_EQ(drawn.Run({retarget, shapes}, pose.joints, std::vector<float>{0.5f}), JobStatus::kOk);
    for (const std::string& name : target.joint_names()) {
      const glm::vec3 at(drawn.model()[target.Find(name)][3]);
      EXPECT_LT(glm::distance(at, OriginOf(target, local, name)), 1e-4f) << name;
    }
  }
}

TEST(CharacterPose, ForgetsTheBlendShapesOfThePoseBefore) {
  const Skeleton body = MakeBody(2);
  const Retarget retarget = Retarget::Create(body, body);
  const BlendShapePose shapes = BlendShapePose::Create(BrowLift(), body, kPoseShapes);
  const LocalPose rest = RestPose(body);
  CharacterPose drawn(&body);
  ASSERT_EQ(drawn.Run({retarget, shapes}, rest.joints, {}), JobStatus::kOk);
  const glm::mat4 before = drawn.model()[body.Find("brow_l")];
  ASSERT_EQ(drawn.Run({retarget, shapes}, rest.joints, std::vector<float>{1.0f}), JobStatus::kOk);
  EXPECT_NE(drawn.model()[body.Find("brow_l")], before);
  ASSERT_EQ(drawn.Run({retarget, shapes}, rest.joints, {}), JobStatus::kOk);
  EXPECT_EQ(drawn.model()[body.Find("brow_l")], before);
}

TEST(CharacterPose, GivesTheWeightsOfTheShapes) {
  const Skeleton body = MakeBody(2);
  const Retarget retarget = Retarget::Create(body, body);
  const std::vector<std::string> shapes = {"jawOpen", "BrowOuterUpLeft"};
  const ShapeProgram program = ShapeProgram::ByName(kPoseShapes, shapes);
  const LocalPose rest = RestPose(body);
  CharacterPose drawn(&body);
  const std::vector<float> half = {0.5f};
  ASSERT_EQ(drawn.Run({retarget, BlendShapePose(), &program}, rest.joints, half), JobStatus::kOk);
  EXPECT_EQ(std::vector<float>(drawn.shapes().begin(), drawn.shapes().end()),
            (std::vector<float>{0.0f, 0.5f}));
  ASSERT_EQ(drawn.Run({retarget, BlendShapePose()}, rest.joints, half), JobStatus::kOk);
  EXPECT_TRUE(drawn.shapes().empty());
}

// An eyeball with a shape and a joint would turn twice.
TEST(CharacterPose, AShapeOfTheNameReplacesTheJoints) {
  const Skeleton body = MakeBody(2);
  const std::vector<std::string> other = {"jawOpen"};
  const std::vector<std::string> same = {"jawOpen", "BrowOuterUpLeft"};
  EXPECT_FALSE(BlendShapePose::Create(BrowLift(), body, kPoseShapes, other).empty());
  EXPECT_TRUE(BlendShapePose::Create(BrowLift(), body, kPoseShapes, same).empty());
}

TEST(CharacterPose, APoseOfAnotherSkeletonFails) {
  const Skeleton body = MakeBody();
  const Retarget retarget = Retarget::Create(body, body);
  LocalPose pose = RestPose(body);
  pose.joints.pop_back();
  EXPECT_NE(CharacterPose(&body).Run({retarget, BlendShapePose()}, pose.joints, {}),
            JobStatus::kOk);
}

}  // namespace
}  // namespace furrow::wrinkle
