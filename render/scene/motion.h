// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "render/graph/frame_graph.h"
#include "render/scene/camera_frame.h"
#include "render/scene/posed_meshes.h"
#include "render/scene/shadow_view.h"

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

// Shadow maps of a stream, which two pictures use: the one that draws them and the next.
struct KeptShadows {
  KeptTexture maps;
  bool is_drawn = false;  // by the former picture
  std::array<ShadowView, kNumLights> views;
  int resolution = 0;  // texels per side
};

// Draws a picture so that each pixel knows where the former picture of its stream showed the same
// surface.
struct SceneMotion {
  // Moves the whole scene, in normalised device coordinates.
  glm::vec2 jitter{0.0f};
  // Added to the level of textures, so that they have the detail of the completed picture.
  float detail = 0.0f;
  // The shadow maps of the former picture, which this picture uses: each surface looks up the place
  // that it had there. Null: this picture has maps of its own.
  const KeptShadows* shadows = nullptr;
  // What the former picture showed; null: there is none, and nothing moves.
  const CameraFrame* camera = nullptr;
  FormerVertices* vertices = nullptr;  // receives vertices that it does not know
};

}  // namespace furrow::render
