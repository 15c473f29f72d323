// SPDX-License-Identifier: Apache-2.0
// The renderer's specular light compared, pixel by pixel, with the formula of Kelemen and
// Szirmay-Kalos on the CPU: a sphere.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "render/scene/lighting.h"
#include "render/skin/beckmann.h"
#include "tests/unit/render/reference/float_picture.h"
#include "tests/unit/render/reference/scenes.h"
#include "tests/unit/render/reference/target_reader.h"

namespace furrow::render {
namespace {

using test::FloatPicture;
using test::SphereOnPlane;

constexpr int kSize = 160;
constexpr SphereOnPlane kScene{{0.0, 0.0, 0.0}, 0.06};
constexpr double kSecondLobe = 0.3;

// Light reflected towards the camera. Radiance at normal incidence is in the lamps' unit, which
// includes the 1 / pi of a white surface.
glm::dvec3 Reflected(const Lighting& lighting, const glm::dvec3& normal,
                     const glm::dvec3& to_camera, double m, SpecularNorm norm) {
  glm::dvec3 sum(0.0);
  for (const LightSource& lamp : lighting.lights) {
    const glm::dvec3 to_light(lamp.direction);
    const double cos_light = glm::dot(normal, to_light);
    const auto lobe = [&](double width) {
      return std::numbers::pi * KelemenBrdf(cos_light, glm::dot(normal, to_camera),
                                            glm::dot(to_light, to_camera), width, kSkinF0, norm);
    };
    const double brdf = glm::mix(lobe(m), lobe(0.5 * m), kSecondLobe);
    sum += glm::dvec3(lamp.radiance) * (brdf * std::max(cos_light, 0.0));
  }
  return sum;
}

struct Case {
  SpecularMode mode;
  SpecularNorm norm;
  float roughness;     // m is its square
  bool table = false;  // look up the Beckmann term
};

class SpecularReference : public testing::TestWithParam<Case> {};

TEST_P(SpecularReference, Sphere) {
  character::Character ball = test::MakeSphereOnPlane(kScene, 1e-4f);
  ball.meshes.erase(ball.meshes.begin());
  for (character::Material& material : ball.materials) material.roughness = GetParam().roughness;
  Camera camera;
  camera.position = {0.0f, 0.0f, 0.5f};
  camera.target = {0.0f, 0.0f, 0.0f};
  camera.fov_y_degrees = 16.0f;
  FrameRequest request = test::SceneRequest(ball, camera, kSize, kSize);
  Settings& settings = request.settings;
  settings.view = View::kSpecular;
  settings.lights.preset = LightPreset::kThesis;
  settings.lights.ambient = 0.0f;
  settings.shadow.filter = ShadowFilter::kOff;
  settings.occlusion.method = OcclusionMethod::kOff;
  settings.specular.mode = GetParam().mode;
  settings.specular.second_lobe = static_cast<float>(kSecondLobe);
  settings.specular.widen = false;
  settings.specular.table = GetParam().table;
  const FloatPicture drawn = test::DrawTarget(ball, request, "scene radiance");
  const Lighting lighting = MakeLighting(settings.lights, {});
  const double m = static_cast<double>(GetParam().roughness) * GetParam().roughness;
  FloatPicture exact(kSize, kSize);
  double brightest = 0.0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const test::Ray ray = test::PixelRay(camera, x, y, kSize, kSize);
      const auto hit = test::FirstHit(kScene, 0.0, ray);
      if (!hit || glm::dot(hit->normal, ray.direction) > -0.1) continue;  // the rim of the facets
      const glm::dvec3 light = Reflected(lighting, hit->normal, -ray.direction, m, GetParam().norm);
      exact.At(x, y) = glm::vec4(glm::vec3(light), 1.0f);
      brightest = std::max(brightest, light.g);
    }
  }
  const test::PictureError error = Compare(drawn, exact, 0);
  std::printf("specular, m %.3f: brightest %.4f, RMSE %.5f, worst %.5f (%zu pixels)\n", m,
              brightest, error.rmse.g, error.worst.g, error.texels);
  EXPECT_GT(error.texels, 8000u);
  EXPECT_LT(error.rmse.g, 0.005 * brightest);
  EXPECT_LT(error.worst.g, 0.03 * brightest);
}

INSTANTIATE_TEST_SUITE_P(
    Modes, SpecularReference,
    testing::Values(Case{SpecularMode::kPhysical, SpecularNorm::kPhysical, 0.45f},
                    Case{SpecularMode::kPhysical, SpecularNorm::kPhysical, 0.6f},
                    Case{SpecularMode::kPhysical, SpecularNorm::kPhysical, 0.6f, true},
                    Case{SpecularMode::kGems, SpecularNorm::kGems, 0.55f}));

}  // namespace
}  // namespace furrow::render
