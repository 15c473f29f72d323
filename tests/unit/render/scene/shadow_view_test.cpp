// SPDX-License-Identifier: Apache-2.0
#include "render/scene/shadow_view.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace furrow::render {
namespace {

constexpr glm::vec3 kCentre(0.1f, 1.6f, -0.05f);
constexpr float kRadius = 0.25f;

// A point as the shaders see it. xy: [-1, 1] in the map, z: depth in [0, 1].
glm::vec3 InMap(const ShadowView& view, const glm::vec3& place) {
  const glm::vec3 p(view.view * glm::vec4(place, 1.0f));
  const float scale = view.scale / (view.perspective ? -p.z : 1.0f);
  return {p.x * scale, p.y * scale, (-p.z - view.near_plane) / view.range};
}

LightSource LightOf(LightKind kind) {
  LightSource light;
  light.kind = kind;
  light.direction = glm::normalize(glm::vec3(-0.5f, 0.8f, 0.6f));
  light.position = kCentre + 1.2f * light.direction;
  return light;
}

TEST(ShadowView, ContainsTheWholeStage) {
  for (const LightKind kind : {LightKind::kDirectional, LightKind::kSpot, LightKind::kPoint}) {
    const ShadowView view = FitShadow(LightOf(kind), kCentre, kRadius, 512);
    for (int i = 0; i < 200; ++i) {  // points distributed over the sphere
      const float z = 1.0f - 2.0f * (static_cast<float>(i) + 0.5f) / 200.0f;
      const float angle = 2.39996f * static_cast<float>(i);
      const float ring = std::sqrt(1.0f - z * z);
      const glm::vec3 place =
          kCentre + kRadius * glm::vec3(ring * std::cos(angle), ring * std::sin(angle), z);
      const glm::vec3 seen = InMap(view, place);
      EXPECT_LE(std::abs(seen.x), 1.01f);
      EXPECT_LE(std::abs(seen.y), 1.01f);
      EXPECT_GE(seen.z, -0.01f);
      EXPECT_LE(seen.z, 1.01f);
    }
  }
}

TEST(ShadowView, DepthIsLinearInMetresForEveryLamp) {
  for (const LightKind kind : {LightKind::kDirectional, LightKind::kSpot}) {
    const LightSource light = LightOf(kind);
    const ShadowView view = FitShadow(light, kCentre, kRadius, 512);
    const float before = InMap(view, kCentre).z;
    const float behind = InMap(view, kCentre - 0.1f * light.direction).z;
    EXPECT_NEAR((behind - before) * view.range, 0.1f, 1e-4f);
  }
}

// If the stage moves by less than a texel, the contents of the map move by whole texels or not at
// all.
TEST(ShadowView, DirectionalMapsMoveInWholeTexels) {
  const LightSource light = LightOf(LightKind::kDirectional);
  const glm::vec3 landmark = kCentre + glm::vec3(0.03f, -0.02f, 0.01f);
  const ShadowView first = FitShadow(light, kCentre, kRadius, 512);
  for (int step = 1; step < 50; ++step) {
    const glm::vec3 moved =
        kCentre + 0.00037f * static_cast<float>(step) * glm::vec3(1, 0.4f, 0.2f);
    const ShadowView view = FitShadow(light, moved, kRadius, 512);
    const glm::vec2 texels = 256.0f * glm::vec2(InMap(view, landmark) - InMap(first, landmark));
    EXPECT_NEAR(texels.x, std::round(texels.x), 0.02f);
    EXPECT_NEAR(texels.y, std::round(texels.y), 0.02f);
  }
}

// As many texels as the picture or the filter can show, and never more than requested.
TEST(ShadowResolution, FitsThePictureAndTheFilter) {
  ShadowSettings settings;
  settings.softness_mm = 0.0f;
  for (const float radius : {0.1f, 0.35f, 2.0f}) {
    for (const float pixel : {0.0002f, 0.0008f, 0.004f}) {
      const int texels = ShadowResolution(settings, radius, pixel);
      EXPECT_EQ(texels % 128, 0);
      EXPECT_TRUE(texels == settings.resolution ||
                  2.0f * radius / static_cast<float>(texels) <= pixel)
          << radius << " " << pixel;
    }
  }
  settings.softness_mm = 3.0f;
  EXPECT_EQ(ShadowResolution(settings, 0.35f, 0.0008f), 512);  // 1.5 mm per texel, not 0.8
  settings.filter = ShadowFilter::kPcss;                       // its edges may be sharp
  EXPECT_EQ(ShadowResolution(settings, 0.35f, 0.0008f), 896);
  settings.resolution = 200;
  EXPECT_EQ(ShadowResolution(settings, 0.35f, 0.0008f), 200);
  settings.fit = false;
  settings.resolution = 1024;
  EXPECT_EQ(ShadowResolution(settings, 0.35f, 0.0008f), 1024);
}

TEST(ShadowView, ALampInsideTheStageHasAFiniteView) {
  LightSource light = LightOf(LightKind::kPoint);
  light.position = kCentre + 0.1f * light.direction;
  const ShadowView view = FitShadow(light, kCentre, kRadius, 512);
  EXPECT_TRUE(std::isfinite(view.scale) && view.scale > 0.0f);
  EXPECT_GT(view.near_plane, 0.0f);
  EXPECT_LE(std::abs(InMap(view, kCentre).x), 1.0f);
}

}  // namespace
}  // namespace furrow::render
