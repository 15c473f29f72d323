// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "render/scene/camera_frame.h"
#include "render/scene/posed_meshes.h"

namespace furrow::render {

// Mirrors Motion of shaders/scene/motion.glsl (std140).
struct MotionBlock {
  glm::mat4 now{1.0f};     // model space to clip space, without the jitter
  glm::mat4 before{1.0f};  // the same for the former picture
  glm::vec4 depth_before{0.0f};
  glm::vec4 detail{0.0f};
};

// The plane by which `camera` measures depth: dot(plane, (position, 1)) is the distance behind the
// focus along the camera's axis, in metres.
[[nodiscard]] inline glm::vec4 FocusPlane(const CameraFrame& camera) {
  const glm::vec3 forward = glm::normalize(camera.target - camera.position);
  return {forward, -glm::dot(forward, camera.target)};
}

// Draws a picture so that each pixel knows where the former picture of its stream showed the same
// surface.
struct SceneMotion {
  // Moves the whole scene, in normalised device coordinates.
  glm::vec2 jitter{0.0f};
  // Added to the level of textures, so that they have the detail of the completed picture.
  float detail = 0.0f;
  // What the former picture showed; null: there is none, and nothing moves.
  const CameraFrame* camera = nullptr;
  const FormerVertices* vertices = nullptr;
};

}  // namespace furrow::render
