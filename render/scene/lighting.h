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

// A lamp, in the model space of the posed character.
struct LightSource {
  LightKind kind = LightKind::kDirectional;
  glm::vec3 position{0.0f};  // metres; for spots and points
  // Unit, from the subject to the light. A spot shines in the opposite direction.
  glm::vec3 direction{0.0f, 0.0f, 1.0f};
  // Linear radiance that a white surface facing the light reflects. For a spot or point light it
  // holds at a distance of `reach` metres and falls with the squared distance.
  glm::vec3 radiance{0.0f};
  float reach = 1.0f;
  float cone_degrees = 180.0f;  // angle between a spot's axis and its edge
};

struct Lighting {
  std::array<LightSource, kNumLights> lights;
  GradientSky sky;
};

// The place that the lights are arranged around.
struct Stage {
  glm::mat3 heading{1.0f};  // rotation of the camera about +Y (CameraFrame::heading)
  glm::vec3 focus{0.0f};    // the camera's target
  float radius = 0.2f;      // metres around the focus that the picture shows
};

// Makes the lamps and the sky of settings.preset around a stage. They turn with the camera, so that
// every view is lit alike.
//
// - studio: a portrait. A warm key (spot) from the upper left, a cool fill (point) from the right,
//   and a rim (directional) from behind on the right. Key and fill come from the sides, which shows
//   folds. The lit cheek has 2.7 times the light of the other, with the sky.
// - hard: one strong spot high on the left and almost no fill, for judging shadows.
// - thesis: three white directional lights, from the left, the right and behind (thesis 5.1).
[[nodiscard]] Lighting MakeLighting(const LightSettings& settings, const Stage& stage);

}  // namespace furrow::render
