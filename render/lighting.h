// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>

namespace furrow::render {

inline constexpr int kNumLights = 3;

// Mirrors Light of shaders/common_frame.glsl.
struct Light {
  glm::vec4 direction;  // xyz: unit, towards the light, model space
  glm::vec4 radiance;   // rgb: linear; a white surface face on returns just this
};

struct Lighting {
  std::array<Light, kNumLights> lights;
  glm::vec4 ambient_sky;     // rgb: linear radiance from above
  glm::vec4 ambient_ground;  // rgb: from below
};

// A portrait studio that stands around the camera: a warm key from the upper left, a cool fill from
// the right, a rim from behind on the right. Low from the side, as the key is, light shows folds
// best. `heading`: the camera's rotation about +Y (CameraFrame::heading).
[[nodiscard]] Lighting StudioLighting(const glm::mat3& heading);

}  // namespace furrow::render
