// SPDX-License-Identifier: Apache-2.0
// Ambient occlusion of the real renderer against rays on the CPU: a sphere on a plane.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "tests/unit/render/reference/ray_cast.h"
#include "tests/unit/render/reference/scenes.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

using test::SphereOnPlane;

constexpr int kSize = 160;
constexpr double kPlaneSize = 0.6;
// Half of it above the plane: nothing that hides the sky is hidden from the camera.
constexpr SphereOnPlane kDome{{0.0, 0.0, 0.0}, 0.08};
// Resting on the plane: what hangs over it is what the camera does not see.
constexpr SphereOnPlane kBall{{0.0, 0.08, 0.0}, 0.08};

Camera AboveThePlane() {
  Camera camera;
  camera.position = {0.0f, 0.40f, 0.50f};
  camera.target = {0.0f, 0.05f, 0.0f};
  camera.fov_y_degrees = 30.0f;
  return camera;
}

struct OcclusionError {
  double mean = 0.0;
  double worst = 0.0;
  double open_mean = 0.0;  // where nothing is near
  int texels = 0;
};

// Of every pixel but those within two of an edge of the picture's depth.
OcclusionError ErrorOf(const Image& image, const SphereOnPlane& scene, double radius) {
  OcclusionError error;
  int open = 0;
  const Camera camera = AboveThePlane();
  // As the shaders fade surfaces out towards the radius.
  const auto hides = [radius](double distance) {
    return std::clamp(1.5 - 1.5 * distance * distance / (radius * radius), 0.0, 1.0);
  };
  const auto hit_at = [&](int x, int y) {
    return FirstHit(scene, 0.95 * kPlaneSize, test::PixelRay(camera, x, y, kSize, kSize));
  };
  for (int y = 2; y < kSize - 2; y += 3) {
    for (int x = 2; x < kSize - 2; x += 3) {
      const auto hit = hit_at(x, y);
      if (!hit) continue;
      bool edge = false;
      for (const int d : {-2, 2}) {
        const auto beside = hit_at(x + d, y);
        const auto above = hit_at(x, y + d);
        edge |= !beside || !above || beside->on_sphere != hit->on_sphere ||
                above->on_sphere != hit->on_sphere;
      }
      if (edge) continue;
      const double exact = Openness(scene, hit->point, hit->normal, hides, 256);
      const auto index = static_cast<std::size_t>(3 * ((kSize - 1 - y) * kSize + x));
      const double drawn = image.rgb[index] / 255.0;
      const double difference = std::abs(drawn - exact);
      error.mean += difference;
      error.worst = std::max(error.worst, difference);
      ++error.texels;
      if (exact == 1.0) {
        error.open_mean += difference;
        ++open;
      }
    }
  }
  error.mean /= error.texels;
  error.open_mean /= open;
  return error;
}

struct Case {
  const char* name;
  OcclusionMethod method;
  SphereOnPlane scene;
  double mean;  // what it may be off by
  double worst;
};

class OcclusionReference : public testing::TestWithParam<Case> {};

TEST_P(OcclusionReference, SphereOnPlane) {
  const SphereOnPlane& sphere = GetParam().scene;
  const character::Character scene = test::MakeSphereOnPlane(sphere, kPlaneSize);
  const std::unique_ptr<Renderer> renderer = test::Expect(Renderer::Create(scene));
  FrameRequest request = test::SceneRequest(scene, AboveThePlane(), kSize, kSize);
  request.settings.view = View::kOcclusion;
  request.settings.occlusion.method = GetParam().method;
  request.settings.occlusion.half_resolution = false;
  request.settings.occlusion.samples = 32;
  for (const float radius_mm : {40.0f, 80.0f}) {
    request.settings.occlusion.radius_mm = radius_mm;
    const Result<Image> image = renderer->Render(request);
    ASSERT_TRUE(image.ok()) << image.status().ToString();
    const OcclusionError error = ErrorOf(*image, sphere, 1e-3 * radius_mm);
    std::printf("%s, radius %.0f mm: mean error %.4f, worst %.3f, in the open %.4f (%d pixels)\n",
                GetParam().name, static_cast<double>(radius_mm), error.mean, error.worst,
                error.open_mean, error.texels);
    EXPECT_GT(error.texels, 1000);
    EXPECT_LT(error.mean, GetParam().mean);
    EXPECT_LT(error.worst, GetParam().worst);
    EXPECT_LT(error.open_mean, 0.02);
  }
}

// Twice the pixels show the same: the radius is in millimetres.
TEST_P(OcclusionReference, TheResolutionChangesNothing) {
  const character::Character scene = test::MakeSphereOnPlane(GetParam().scene, kPlaneSize);
  const std::unique_ptr<Renderer> renderer = test::Expect(Renderer::Create(scene));
  FrameRequest request = test::SceneRequest(scene, AboveThePlane(), kSize, kSize);
  request.settings.view = View::kOcclusion;
  request.settings.occlusion.method = GetParam().method;
  request.settings.occlusion.radius_mm = 50.0f;
  request.settings.occlusion.samples = 32;
  const Result<Image> small = renderer->Render(request);
  request.width = request.height = 2 * kSize;
  const Result<Image> large = renderer->Render(request);
  ASSERT_TRUE(small.ok() && large.ok());
  double sums[2] = {0.0, 0.0};
  for (const std::uint8_t value : small->rgb) sums[0] += value / 255.0;
  for (const std::uint8_t value : large->rgb) sums[1] += value / 255.0 / 4.0;
  EXPECT_NEAR(sums[0], sums[1], 0.01 * sums[0]);
}

INSTANTIATE_TEST_SUITE_P(
    Methods, OcclusionReference,
    testing::Values(Case{"gtao_dome", OcclusionMethod::kGtao, kDome, 0.03, 0.2},
                    Case{"gtao_ball", OcclusionMethod::kGtao, kBall, 0.05, 0.75},
                    Case{"ssao_dome", OcclusionMethod::kSsao, kDome, 0.03, 0.3},
                    Case{"ssao_ball", OcclusionMethod::kSsao, kBall, 0.03, 0.4}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace furrow::render
