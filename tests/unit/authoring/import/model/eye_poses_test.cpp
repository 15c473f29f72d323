// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/eye_poses.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "wrinkle/shapes/blend_shape_pose.h"

namespace furrow::authoring {
namespace {

// Eyes whose own axes are turned, as most exporters write them.
wrinkle::Skeleton Eyes() {
  const glm::quat turned = glm::angleAxis(1.2f, glm::normalize(glm::vec3(1, 2, 3)));
  const wrinkle::Transform head{.translation = {0, 1.6f, 0}, .rotation = turned};
  const auto eye = [&](float x) {
    return wrinkle::Transform{.translation = glm::conjugate(turned) * glm::vec3(x, 0.1f, 0.1f),
                              .rotation = glm::angleAxis(2.0f, glm::vec3(0, 0, 1))};
  };
  auto skeleton =
      wrinkle::Skeleton::Create({{.name = "head", .parent = -1, .rest = head, .tail = {}},
                                 {.name = "L", .parent = 0, .rest = eye(0.03f), .tail = {}},
                                 {.name = "R", .parent = 0, .rest = eye(-0.03f), .tail = {}}});
  EXPECT_TRUE(skeleton.ok());
  return *std::move(skeleton);
}

wrinkle::JointRoles RolesOf(const wrinkle::Skeleton& skeleton) {
  wrinkle::JointRoles roles(3, wrinkle::JointRole::kNone);
  roles[static_cast<std::size_t>(skeleton.Find("L"))] = wrinkle::JointRole::kLeftEye;
  roles[static_cast<std::size_t>(skeleton.Find("R"))] = wrinkle::JointRole::kRightEye;
  return roles;
}

// Where a joint that rests looking along +Z looks when the shape is 1.
glm::vec3 Gaze(const wrinkle::Rig& rig, const wrinkle::Skeleton& skeleton, const std::string& shape,
               const char* joint) {
  const std::vector<std::string> stream = {shape};
  const auto pose = wrinkle::BlendShapePose::Create(rig, skeleton, stream);
  EXPECT_FALSE(pose.empty()) << shape;
  std::vector<wrinkle::Transform> local(skeleton.rest_pose().begin(), skeleton.rest_pose().end());
  EXPECT_EQ(pose.Run(std::vector<float>{1.0f}, local), wrinkle::JobStatus::kOk);
  std::vector<glm::mat4> model(3);
  EXPECT_EQ((wrinkle::LocalToModelJob{&skeleton, local, model}.Run()), wrinkle::JobStatus::kOk);
  const int index = skeleton.Find(joint);
  return glm::mat3(model[static_cast<std::size_t>(index)]) *
         glm::transpose(glm::mat3(skeleton.rest_model()[index])) * glm::vec3(0, 0, 1);
}

float Sine(float degrees) { return std::sin(degrees * 3.14159265f / 180.0f); }

TEST(EyePoses, LookWhereTheirNamesSay) {
  const wrinkle::Skeleton skeleton = Eyes();
  wrinkle::Rig rig;
  ASSERT_TRUE(AddEyePoses(skeleton, RolesOf(skeleton), EyeSurface(), &rig));
  EXPECT_EQ(rig.reference_poses.size(), 8u);
  EXPECT_NEAR(Gaze(rig, skeleton, "eyeLookUpLeft", "L").y, Sine(25), 1e-4f);
  EXPECT_NEAR(Gaze(rig, skeleton, "eyeLookDownRight", "R").y, -Sine(30), 1e-4f);
  // The subject's left is +X.
  EXPECT_NEAR(Gaze(rig, skeleton, "eyeLookOutLeft", "L").x, Sine(30), 1e-4f);
  EXPECT_NEAR(Gaze(rig, skeleton, "eyeLookInLeft", "L").x, -Sine(30), 1e-4f);
  EXPECT_NEAR(Gaze(rig, skeleton, "eyeLookOutRight", "R").x, -Sine(30), 1e-4f);
  EXPECT_NEAR(Gaze(rig, skeleton, "eyeLookInRight", "R").x, Sine(30), 1e-4f);
  EXPECT_NEAR(Gaze(rig, skeleton, "eyeLookInRight", "L").x, 0.0f, 1e-5f) << "the other eye stays";
}

// A gaze of 30 degrees is a third of 90, and beyond 10.
TEST(EyePoses, FollowTheRangesOfTheAvatar) {
  const wrinkle::Skeleton skeleton = Eyes();
  wrinkle::Rig rig;
  const gltf::VrmLookAt look_at{
      .inner = {90.0f, 12.0f}, .outer = {10.0f, 20.0f}, .down = {30.0f, 8.0f}, .up = {0.0f, 5.0f}};
  ASSERT_TRUE(AddEyePoses(skeleton, RolesOf(skeleton), {.look_at = look_at}, &rig));
  EXPECT_NEAR(Gaze(rig, skeleton, "eyeLookInLeft", "L").x, -Sine(4), 1e-4f);
  EXPECT_NEAR(Gaze(rig, skeleton, "eyeLookOutLeft", "L").x, Sine(20), 1e-4f);
  EXPECT_NEAR(Gaze(rig, skeleton, "eyeLookDownLeft", "L").y, -Sine(8), 1e-4f);
  EXPECT_NEAR(Gaze(rig, skeleton, "eyeLookUpLeft", "L").y, Sine(5), 1e-4f);
}

// The iris of a drawn face is a plate far before its joint, and sinks into the eye if it turns as
// far as a ball. Here the joint is at (0.03, 1.7, 0.1), and the width is 0.02.
TEST(EyePoses, TurnFlatIrisesLess) {
  const wrinkle::Skeleton skeleton = Eyes();
  const auto left = static_cast<std::uint16_t>(skeleton.Find("L"));
  for (const float before : {0.0f, 0.05f}) {
    character::Mesh mesh;
    for (const glm::vec3 corner :
         {glm::vec3(0.02f, 1.69f, 0.09f + before), glm::vec3(0.04f, 1.71f, 0.11f + before)}) {
      character::Vertex& vertex = mesh.vertices.emplace_back();
      vertex.position = corner;
      vertex.joints[0] = left;
      vertex.skin_weights[0] = 1.0f;
    }
    wrinkle::Rig rig;
    ASSERT_TRUE(AddEyePoses(skeleton, RolesOf(skeleton), {.meshes = {&mesh, 1}}, &rig));
    const float side = Gaze(rig, skeleton, "eyeLookOutLeft", "L").x;
    EXPECT_NEAR(side, before > 0.0f ? std::sin(0.2f * 0.02f / 0.05f) : Sine(30), 1e-4f);
    EXPECT_NEAR(Gaze(rig, skeleton, "eyeLookUpRight", "R").y, Sine(25), 1e-4f)
        << "nothing follows the right eye";
  }
}

TEST(EyePoses, KeepThoseOfTheRigAndNeedBothEyes) {
  const wrinkle::Skeleton skeleton = Eyes();
  wrinkle::Rig rig;
  rig.reference_poses.push_back({.name = "eyeLookUpLeft"});
  EXPECT_TRUE(AddEyePoses(skeleton, RolesOf(skeleton), EyeSurface(), &rig));
  EXPECT_EQ(rig.reference_poses.size(), 8u);
  EXPECT_TRUE(rig.reference_poses[0].joints.empty());
  wrinkle::Rig none;
  EXPECT_FALSE(AddEyePoses(skeleton, wrinkle::JointRoles(3), EyeSurface(), &none));
  EXPECT_TRUE(none.reference_poses.empty());
}

}  // namespace
}  // namespace furrow::authoring
