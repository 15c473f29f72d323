// SPDX-License-Identifier: Apache-2.0
#include "render/request/camera_preset.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "render/scene/camera_frame.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

Camera Preset(const character::Character& character, const std::string& name) {
  for (const auto& [preset, camera] : CameraPresets(character)) {
    if (preset == name) return camera;
  }
  ADD_FAILURE() << "no preset " << name;
  return {};
}

// Normalised device coordinates of a point in the rest pose, in a square picture.
glm::vec3 Project(const character::Character& character, const Camera& camera,
                  const glm::vec3& point) {
  const CameraFrame frame =
      ComputeCamera(camera, character.skeleton, character.skeleton.rest_model(), 1.0f);
  const glm::vec4 clip = frame.view_projection * glm::vec4(point, 1.0f);
  return glm::vec3(clip) / clip.w;
}

TEST(CameraPreset, HeadPresetsShowTheWholeHeadAndFillThePicture) {
  const character::Character head = test::MakeHead();
  for (const char* name : {"face", "three_quarter", "profile"}) {
    float extent = 0.0f;
    for (const character::Vertex& vertex : head.meshes[0].vertices) {
      const glm::vec3 point = Project(head, Preset(head, name), vertex.position);
      extent = std::max({extent, std::abs(point.x), std::abs(point.y)});
      EXPECT_GT(point.z, -1.0f);
      EXPECT_LT(point.z, 1.0f);
    }
    EXPECT_LT(extent, 0.97f) << name;
    EXPECT_GT(extent, 0.7f) << name;
  }
}

TEST(CameraPreset, IsWhereItsNameSays) {
  const character::Character head = test::MakeHead();
  const auto direction = [&](const char* name) {
    const Camera camera = Preset(head, name);
    return glm::normalize(camera.position - camera.target);
  };
  EXPECT_NEAR(direction("face").z, 1.0f, 1e-5);
  EXPECT_NEAR(direction("profile").x, 1.0f, 1e-5);
  EXPECT_NEAR(direction("three_quarter").x, std::sin(glm::radians(38.0f)), 1e-5);
  EXPECT_GT(Preset(head, "eyes").target.y, Preset(head, "mouth").target.y + 0.03f);
  EXPECT_NEAR(direction("body").z, 1.0f, 1e-5);
  EXPECT_NEAR(direction("body_three_quarter").x, std::sin(glm::radians(38.0f)), 1e-5);
  EXPECT_NEAR(direction("body_side").x, 1.0f, 1e-5);
  EXPECT_NEAR(direction("body_back").z, -1.0f, 1e-5);
}

TEST(CameraPreset, NamesMatchThePresets) {
  const auto presets = CameraPresets(test::MakeHead());
  ASSERT_EQ(presets.size(), CameraPresetNames().size());
  for (std::size_t i = 0; i < presets.size(); ++i) {
    EXPECT_EQ(presets[i].first, CameraPresetNames()[i]);
  }
}

// In pictures of any shape, the whole height is visible with little space above and below.
TEST(CameraPreset, BodyPresetsFillThePicturesHeight) {
  const character::Character head = test::MakeHead();
  for (const char* name : {"body", "body_three_quarter", "body_side", "body_back"}) {
    for (const float aspect : {0.6f, 1.0f, 1.8f}) {
      const CameraFrame frame =
          ComputeCamera(Preset(head, name), head.skeleton, head.skeleton.rest_model(), aspect);
      float extent = 0.0f;
      for (const character::Vertex& vertex : head.meshes[0].vertices) {
        const glm::vec4 clip = frame.view_projection * glm::vec4(vertex.position, 1.0f);
        extent = std::max(extent, std::abs(clip.y / clip.w));
      }
      EXPECT_LT(extent, 1.0f) << name << aspect;
      EXPECT_GT(extent, 0.7f) << name << aspect;
    }
  }
}

// A body below the head must not pull the face camera down, and neither must joints without skin.
TEST(CameraPreset, FramesTheHeadOfACharacterWithABody) {
  character::Character character = test::MakeHead();
  const Camera alone = Preset(character, "face");
  character::Mesh body = character.meshes[0];
  for (character::Vertex& vertex : body.vertices) {
    vertex.position = (vertex.position - glm::vec3(0, 1.6f, 0)) * 5.0f + glm::vec3(0, 0.8f, 0);
    vertex.joints[0] = 0;
    vertex.skin_weights[0] = 1.0f;
    vertex.skin_weights[1] = 0.0f;
  }
  character.meshes.push_back(body);
  const Camera with_body = Preset(character, "face");
  EXPECT_NEAR(glm::length(with_body.position - alone.position), 0.0f, 1e-4);
  const Camera whole = Preset(character, "body");
  EXPECT_LT(std::abs(Project(character, whole, {0.0f, 0.2f, 0.0f}).y), 1.0f);
  EXPECT_LT(std::abs(Project(character, whole, {0.0f, 1.72f, 0.0f}).y), 1.0f);
}

// Exporters add a node for the whole scene above the hips. It does not move with the body.
TEST(CameraPreset, FollowsTheBodyAndNotTheScene) {
  character::Character character = test::MakeHead();
  EXPECT_EQ(Preset(character, "body").follow_joint, 0) << "a head alone";
  EXPECT_EQ(Preset(character, "face").turn_joint, 0) << "its turns must be seen";
  std::vector<wrinkle::JointDesc> joints;
  for (int j = 0; j < character.skeleton.num_joints(); ++j) {
    const auto index = static_cast<std::size_t>(j);
    joints.push_back({character.skeleton.joint_names()[index],
                      character.skeleton.joint_parents()[index] + 1,
                      character.skeleton.rest_pose()[index],
                      {}});
  }
  joints.insert(joints.begin(), {.name = "scene", .parent = -1, .rest = {}, .tail = {}});
  character.skeleton = *wrinkle::Skeleton::Create(joints);
  for (character::Vertex& vertex : character.meshes[0].vertices) {
    for (auto& joint : vertex.joints) ++joint;
  }
  character.meshes[0].vertices[0].joints[1] = 1;  // the old root moves something
  character.meshes[0].vertices[0].skin_weights[1] = 0.5f;
  EXPECT_EQ(Preset(character, "body").follow_joint, 1);
  const Camera face = Preset(character, "face");
  EXPECT_EQ(face.follow_joint, character.skeleton.Find(character.rig.anchor));
  EXPECT_EQ(face.turn_joint, 1);
  // The camera stays in front of a body that turns.
  std::vector<glm::mat4> model(character.skeleton.rest_model().begin(),
                               character.skeleton.rest_model().end());
  const glm::mat4 turn = glm::rotate(glm::mat4(1.0f), 2.0f, glm::vec3(0, 1, 0));
  for (std::size_t j = 1; j < model.size(); ++j) model[j] = turn * model[j];
  const glm::vec3 position = ComputeCamera(face, character.skeleton, model, 1.0f).position;
  EXPECT_LT(glm::length(position - glm::vec3(turn * glm::vec4(face.position, 1.0f))), 1e-4f);
}

TEST(CameraPreset, ACharacterWithoutVerticesStillGetsFiniteCameras) {
  character::Character empty = test::MakeHead();
  empty.meshes.clear();
  for (const auto& [name, camera] : CameraPresets(empty)) {
    EXPECT_TRUE(std::isfinite(camera.position.z)) << name;
    EXPECT_GT(glm::length(camera.position - camera.target), 1e-4f) << name;
  }
}

TEST(CameraPreset, TheErrorListsTheNames) {
  const Status status = UnknownPreset("ceiling");
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(status.ToString().find("three_quarter"), std::string::npos);
}

}  // namespace
}  // namespace furrow::render
