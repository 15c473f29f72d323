// SPDX-License-Identifier: Apache-2.0
#include "render/scene/lighting.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace furrow::render {
namespace {

constexpr glm::vec3 kLuminance(0.2126f, 0.7152f, 0.0722f);
// Cheeks of a face that looks at the camera, turned by 37 degrees to either side.
constexpr glm::vec3 kLitCheek(-0.6f, 0.0f, 0.8f), kShadedCheek(0.6f, 0.0f, 0.8f);
enum Lamp { kKey, kFill, kRim };

// Luminance of white surfaces at the focus.
float FromLamp(const Lighting& lighting, Lamp lamp, const glm::vec3& normal) {
  const LightSource& light = lighting.lights[lamp];
  return glm::dot(light.radiance, kLuminance) * std::max(glm::dot(light.direction, normal), 0.0f);
}
float FromSky(const Lighting& lighting, const glm::vec3& normal) {
  const GradientSky& sky = lighting.sky;
  const auto polynomial = AmbientPolynomial(
      ProjectRadiance([&](const glm::vec3& direction) { return SkyRadiance(sky, direction); }));
  return glm::dot(EvaluateAmbient(polynomial, normal), kLuminance);
}

// A portrait has three to four times as much light on the lit cheek as in the key's shadow.
TEST(StudioLights, FillTheShadowsOfAPortrait) {
  const Lighting studio = MakeLighting({}, {});
  const float lit = FromLamp(studio, kKey, kLitCheek) + FromLamp(studio, kFill, kLitCheek) +
                    FromSky(studio, kLitCheek);
  const float shadow = FromLamp(studio, kFill, kShadedCheek) + FromSky(studio, kShadedCheek);
  EXPECT_GT(lit / shadow, 3.0f);
  EXPECT_LT(lit / shadow, 4.0f);
}

// Frontal light hides folds.
TEST(StudioLights, ComeFromBothSides) {
  const Lighting studio = MakeLighting({}, {});
  EXPECT_LT(studio.lights[kKey].direction.x, -0.5f);
  EXPECT_GT(studio.lights[kFill].direction.x, 0.5f);
  for (const Lamp lamp : {kKey, kFill}) EXPECT_LT(studio.lights[lamp].direction.z, 0.71f);
}

// Folds beside the eyes face the side, 30 degrees towards the camera. The rim leaves them alone.
TEST(StudioLights, RimGrazesTheOutlineOnly) {
  const Lighting studio = MakeLighting({}, {});
  EXPECT_EQ(FromLamp(studio, kRim, glm::vec3(0.0f, 0.0f, 1.0f)), 0.0f);
  EXPECT_EQ(FromLamp(studio, kRim, glm::vec3(0.866f, 0.0f, 0.5f)), 0.0f);
  EXPECT_GT(FromLamp(studio, kRim, glm::vec3(1.0f, 0.0f, 0.0f)), 0.05f);
}

TEST(StudioLights, FiltersTurnLampsOff) {
  LightSettings settings;
  settings.fill = glm::vec3(0.0f);
  const Lighting lighting = MakeLighting(settings, {});
  EXPECT_EQ(lighting.lights[kFill].radiance, glm::vec3(0.0f));
  EXPECT_GT(lighting.lights[kKey].radiance.x, 0.0f);
}

}  // namespace
}  // namespace furrow::render
