// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "render/scene/sky_light.h"
#include "render/settings/settings.h"

namespace furrow::render {

inline constexpr int kNumLights = 3;

enum class LightKind { kDirectional, kSpot, kPoint };

struct LightSource {
  LightKind kind = LightKind::kDirectional;
  glm::vec3 position{0.0f};  // model space; of spots and points
  // Unit, towards the light. A spot shines along its opposite.
  glm::vec3 direction{0.0f, 0.0f, 1.0f};
  // Linear. A white surface face on returns just this, at `reach` metres from a light with a place.
  glm::vec3 radiance{0.0f};
  float reach = 1.0f;
  float cone_degrees = 180.0f;  // between a spot's axis and its edge
};

struct Lighting {
  std::array<LightSource, kNumLights> lights;
  GradientSky sky;
};

// Where the subject is, for lights to stand around it.
struct Stage {
  glm::mat3 heading{1.0f};  // of the camera about +Y (CameraFrame::heading)
  glm::vec3 focus{0.0f};    // what the camera looks at
  float radius = 0.2f;      // metres around the focus that the picture shows
};

// The lamps of a preset. They turn with the camera, so that every view is lit alike.
//
// - studio: a warm soft key (spot) from the upper left, a cool fill (point) from the right, a rim
//   (directional) from behind on the right. Low from the side, as the key is, light shows folds.
// - hard: one strong spot high on the left, next to no fill: for judging shadows.
// - thesis: three directional lights, white, from the left, the right and behind (its 5.1).
[[nodiscard]] Lighting MakeLighting(const LightSettings& settings, const Stage& stage);

}  // namespace furrow::render
