// SPDX-License-Identifier: Apache-2.0
// The renderer's shadows compared with rays on the CPU: a sphere on a plane.
#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "render/scene/frame_block.h"
#include "tests/unit/render/reference/ray_cast.h"
#include "tests/unit/render/reference/scenes.h"
#include "tests/unit/render/reference/target_reader.h"

namespace furrow::render {
namespace {

using test::FloatPicture;
using test::SphereOnPlane;

constexpr int kShadowSize = 256;
constexpr double kShadowPlane = 0.6;
// As large as a head, at the distance of a portrait.
constexpr SphereOnPlane kScene{{0.0, 0.08, 0.0}, 0.08};
// Allowed distance of a shadow's edge on the surface, metres: the filter's radius, the normal
// offset and two texels of the map.
constexpr double kTolerance = 0.003;

bool SeesLamp(const glm::dvec3& point, const glm::dvec3& normal, const LightSource& lamp) {
  return lamp.kind == LightKind::kDirectional
             ? SeesLight(kScene, point, normal, glm::dvec3(lamp.direction))
             : SeesPoint(kScene, point, normal, glm::dvec3(lamp.position));
}

// A spot lights nothing outside its cone, so there are no shadows either.
bool Lights(const LightSource& lamp, const glm::dvec3& point) {
  if (lamp.kind != LightKind::kSpot) return true;
  const glm::dvec3 to_light = glm::normalize(glm::dvec3(lamp.position) - point);
  return glm::dot(to_light, glm::dvec3(lamp.direction)) >
         std::cos(glm::radians(static_cast<double>(lamp.cone_degrees)));
}

// Whether the point sees the lamp; nullopt if points within the tolerance disagree.
std::optional<bool> Seen(const test::Hit& hit, const LightSource& lamp) {
  const bool seen = SeesLamp(hit.point, hit.normal, lamp);
  const glm::dvec3 side = glm::normalize(glm::cross(hit.normal, glm::dvec3(0.3, 0.1, 1.0)));
  const glm::dvec3 other = glm::cross(hit.normal, side);
  for (int i = 0; i < 12; ++i) {
    const double angle = 2.0 * 3.14159265358979 * i / 12;
    glm::dvec3 point = hit.point + kTolerance * (std::cos(angle) * side + std::sin(angle) * other);
    glm::dvec3 normal = hit.normal;
    if (hit.on_sphere) {
      normal = glm::normalize(point - kScene.centre);
      point = kScene.centre + kScene.radius * normal;
    }
    if (SeesLamp(point, normal, lamp) != seen) return {};
  }
  return seen;
}

// A lamp's shadows compared with rays, where all points within the tolerance agree.
struct Comparison {
  int light = 0;
  double height = 0.0;  // sine of the lamp's height above the plane
  int lit = 0;
  int dark = 0;
  int wrong = 0;
  double mean_error = 0.0;
};

Comparison Compare(const FloatPicture& visible, const Camera& camera, int light,
                   const LightSource& lamp) {
  Comparison found{.light = light, .height = static_cast<double>(lamp.direction.y)};
  for (int y = 0; y < kShadowSize; ++y) {
    for (int x = 0; x < kShadowSize; ++x) {
      const std::optional<test::Hit> hit = FirstHit(
          kScene, 0.98 * kShadowPlane, test::PixelRay(camera, x, y, kShadowSize, kShadowSize));
      if (!hit || !Lights(lamp, hit->point)) continue;
      const std::optional<bool> seen = Seen(*hit, lamp);
      if (!seen) continue;
      ++(*seen ? found.lit : found.dark);
      const double error = std::abs(visible.At(x, y)[light] - (*seen ? 1.0 : 0.0));
      found.mean_error += error;
      if (error > 0.01) ++found.wrong;
    }
  }
  found.mean_error /= found.lit + found.dark;
  return found;
}

// The lamps of a preset with non-zero radiance.
std::vector<Comparison> CompareLamps(LightPreset preset, const ShadowSettings& shadow) {
  const character::Character scene = test::MakeSphereOnPlane(kScene, kShadowPlane);
  const Camera camera = test::SphereCamera({0.0f, 0.35f, 0.60f});
  FrameRequest request = test::SceneRequest(scene, camera, kShadowSize, kShadowSize);
  request.settings.view = View::kShadow;
  request.settings.lights.preset = preset;
  request.settings.shadow = shadow;
  const FloatPicture visible = test::DrawTarget(scene, request, "scene radiance");
  AmbientCache sky;
  const Lighting lighting = SetUpFrame(request, scene.skeleton, &sky).lighting;
  std::vector<Comparison> all;
  for (int light = 0; light < kNumLights; ++light) {
    const LightSource& lamp = lighting.lights[static_cast<std::size_t>(light)];
    if (lamp.radiance == glm::vec3(0.0f)) continue;
    all.push_back(Compare(visible, camera, light, lamp));
    const Comparison& last = all.back();
    std::printf("shadow of lamp %d: %d lit, %d dark, %d wrong, mean error %.5f\n", light, last.lit,
                last.dark, last.wrong, last.mean_error);
  }
  return all;
}

class ShadowReference : public testing::TestWithParam<LightPreset> {};

TEST_P(ShadowReference, SphereOnPlane) {
  ShadowSettings shadow;
  shadow.softness_mm = 0.5f;
  shadow.resolution = 2048;
  shadow.fit = false;
  for (const Comparison& found : CompareLamps(GetParam(), shadow)) {
    EXPECT_GT(found.lit, 5000);
    EXPECT_GT(found.dark, 2000);
    // At most one in a thousand pixels farther than kTolerance from an edge is wrong.
    EXPECT_LE(found.wrong, (found.lit + found.dark) / 1000) << "lamp " << found.light;
  }
}

// Maps with only as many texels as the picture can show are as good as large ones: no
// self-shadowing, and no detached shadows, sharp or soft.
TEST_P(ShadowReference, FittedMapsAreAsAccurate) {
  for (const float softness_mm : {0.5f, 3.0f}) {
    ShadowSettings shadow;
    shadow.softness_mm = softness_mm;
    shadow.fit = false;
    const std::vector<Comparison> large = CompareLamps(GetParam(), shadow);
    shadow.fit = true;
    const std::vector<Comparison> fitted = CompareLamps(GetParam(), shadow);
    for (std::size_t i = 0; i < large.size(); ++i) {
      // A texel as large as a pixel may move a sharp edge beyond the tolerance. The lower the lamp,
      // the longer the texel is on the plane.
      const double reach = std::max(1.0, 0.33 / large[i].height);
      const double edge = reach * (fitted[i].lit + fitted[i].dark) / 500;
      EXPECT_LE(fitted[i].wrong, large[i].wrong + edge) << "lamp " << large[i].light;
      EXPECT_LE(fitted[i].mean_error, large[i].mean_error + reach * 5e-4)
          << "lamp " << large[i].light;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, ShadowReference,
                         testing::Values(LightPreset::kThesis, LightPreset::kStudio,
                                         LightPreset::kHard));

}  // namespace
}  // namespace furrow::render
