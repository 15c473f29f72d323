// SPDX-License-Identifier: Apache-2.0
#include "render/scene/camera_frame.h"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "render/request/camera_preset.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

Camera FacePreset(const character::Character& character) {
  return CameraPresets(character).front().second;
}

// A subject that walks away and turns looks the same as one that stays.
TEST(ComputeCamera, FollowsASubjectThatTravelsAndTurns) {
  const character::Character head = test::MakeHead();
  const glm::mat4 moved = glm::translate(glm::mat4(1.0f), {3.0f, 0.2f, -2.0f}) *
                          glm::rotate(glm::mat4(1.0f), 2.5f, {0.0f, 1.0f, 0.0f});
  std::vector<glm::mat4> model;
  for (const glm::mat4& rest : head.skeleton.rest_model()) model.push_back(moved * rest);
  const Camera camera = FacePreset(head);
  const CameraFrame still = ComputeCamera(camera, head.skeleton, head.skeleton.rest_model(), 1.0f);
  const CameraFrame followed = ComputeCamera(camera, head.skeleton, model, 1.0f);
  const glm::mat4 expected = still.view_projection * glm::inverse(moved);
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      EXPECT_NEAR(followed.view_projection[column][row], expected[column][row], 2e-4);
    }
  }
  Camera fixed = camera;
  fixed.follow_joint = -1;
  EXPECT_EQ(ComputeCamera(fixed, head.skeleton, model, 1.0f).position, still.position);
}

// Presets show the same square of the subject in the centre of a picture of any shape. Custom
// cameras keep their vertical angle.
TEST(ComputeCamera, PresetsShowTheSameWidthInPortraitFormat) {
  const character::Character head = test::MakeHead();
  Camera camera = FacePreset(head);
  const auto project = [&](float aspect) {
    const CameraFrame frame =
        ComputeCamera(camera, head.skeleton, head.skeleton.rest_model(), aspect);
    const glm::vec4 clip =
        frame.view_projection * glm::vec4(camera.target + glm::vec3(0.05f, 0.05f, 0.0f), 1.0f);
    return glm::vec2(clip) / clip.w;
  };
  const glm::vec2 square = project(1.0f);
  EXPECT_GT(square.x, 0.1f);
  EXPECT_NEAR(project(0.5f).x, square.x, 1e-5f);
  EXPECT_NEAR(project(0.5f).y, square.y * 0.5f, 1e-5f);
  EXPECT_NEAR(project(2.0f).x, square.x * 0.5f, 1e-5f);
  EXPECT_NEAR(project(2.0f).y, square.y, 1e-5f);
  camera.fit_shorter_side = false;
  EXPECT_NEAR(project(0.5f).y, square.y, 1e-5f);
}

TEST(ComputeCamera, LooksStraightDownWithoutDegenerating) {
  const character::Character head = test::MakeHead();
  Camera camera;
  camera.position = {0.0f, 3.0f, 0.0f};
  camera.target = {0.0f, 1.0f, 0.0f};
  const CameraFrame frame = ComputeCamera(camera, head.skeleton, head.skeleton.rest_model(), 1.0f);
  const glm::vec4 clip = frame.view_projection * glm::vec4(camera.target, 1.0f);
  const glm::vec3 centre = glm::vec3(clip) / clip.w;
  EXPECT_NEAR(centre.x, 0.0f, 1e-5);
  EXPECT_NEAR(centre.y, 0.0f, 1e-5);
}

}  // namespace
}  // namespace furrow::render
