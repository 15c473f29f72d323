// SPDX-License-Identifier: Apache-2.0
// The renderer's ambient occlusion compared with rays on the CPU: a sphere on a plane.
#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "tests/unit/render/reference/ray_cast.h"
#include "tests/unit/render/reference/scenes.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

using test::SphereOnPlane;

constexpr int kOcclusionSize = 160;
constexpr double kOcclusionPlane = 0.6;
const glm::vec3 kOcclusionEye(0.0f, 0.40f, 0.50f);
// Half of the sphere is above the plane. The camera sees everything that occludes.
constexpr SphereOnPlane kDome{{0.0, 0.0, 0.0}, 0.08};
// A sphere that rests on the plane. The camera does not see its overhanging part, which occludes
// too.
constexpr SphereOnPlane kBall{{0.0, 0.08, 0.0}, 0.08};

struct OcclusionError {
  double mean = 0.0;
  double most = 0.0;  // 95th percentile of the errors
  double worst = 0.0;
  double open_mean = 0.0;  // far from any occluder
  int texels = 0;
};

// Errors over evenly spaced pixels, without those within two pixels of a depth discontinuity.
OcclusionError ErrorOf(const Image& image, const SphereOnPlane& scene, double radius) {
  OcclusionError error;
  std::vector<double> differences;
  int open = 0;
  const int size = image.width;
  const int step = 3 * size / kOcclusionSize;
  const Camera camera = test::SphereCamera(kOcclusionEye);
  // Fades occluders towards the radius like the shaders.
  const auto hides = [radius](double distance) {
    return std::clamp(1.5 - 1.5 * distance * distance / (radius * radius), 0.0, 1.0);
  };
  const auto hit_at = [&](int x, int y) {
    return FirstHit(scene, 0.95 * kOcclusionPlane, test::PixelRay(camera, x, y, size, size));
  };
  for (int y = 2; y < size - 2; y += step) {
    for (int x = 2; x < size - 2; x += step) {
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
      const auto index = static_cast<std::size_t>(3 * ((size - 1 - y) * size + x));
      const double drawn = image.rgb[index] / 255.0;
      const double difference = std::abs(drawn - exact);
      differences.push_back(difference);
      error.mean += difference;
      if (exact == 1.0) {
        error.open_mean += difference;
        ++open;
      }
    }
  }
  std::ranges::sort(differences);
  error.texels = static_cast<int>(differences.size());
  error.worst = differences.back();
  error.most = differences[differences.size() * 95 / 100];
  error.mean /= error.texels;
  error.open_mean /= open;
  return error;
}

// A view: picture size in pixels per side, and visible width in millimetres.
struct Look {
  int size;
  float radius_mm;
};
const std::vector<Look> kFar = {{kOcclusionSize, 40.0f}, {kOcclusionSize, 80.0f}};
const std::vector<Look> kNear = {{4 * kOcclusionSize, 190.0f}};  // the radius is 350 pixels

OcclusionSettings Fine(OcclusionMethod method) {
  OcclusionSettings settings;
  settings.method = method;
  settings.half_resolution = false;
  settings.samples = 32;
  return settings;
}

struct Case {
  const char* name;
  OcclusionSettings settings;
  SphereOnPlane scene;
  std::vector<Look> looks;
  OcclusionError tolerance;
};

void PrintTo(const Case& tested, std::ostream* out) { *out << tested.name; }

class OcclusionReference : public testing::TestWithParam<Case> {
 protected:
  [[nodiscard]] Image Draw(int size, float radius_mm) {
    FrameRequest request =
        test::SceneRequest(scene_, test::SphereCamera(kOcclusionEye), size, size);
    request.settings.view = View::kOcclusion;
    request.settings.occlusion = GetParam().settings;
    request.settings.occlusion.radius_mm = radius_mm;
    return test::Expect(renderer_->Render(request));
  }

  character::Character scene_ = test::MakeSphereOnPlane(GetParam().scene, kOcclusionPlane);
  std::unique_ptr<Renderer> renderer_ = test::Expect(Renderer::Create(scene_));
};

TEST_P(OcclusionReference, SphereOnPlane) {
  for (const auto& [size, radius_mm] : GetParam().looks) {
    const OcclusionError error =
        ErrorOf(Draw(size, radius_mm), GetParam().scene, 1e-3 * static_cast<double>(radius_mm));
    std::printf(
        "%s, radius %.0f mm: mean error %.4f, 95%% below %.3f, worst %.3f, in the open %.4f (%d "
        "pixels)\n",
        GetParam().name, static_cast<double>(radius_mm), error.mean, error.most, error.worst,
        error.open_mean, error.texels);
    const OcclusionError& tolerance = GetParam().tolerance;
    EXPECT_GT(error.texels, 1000);
    EXPECT_LT(error.mean, tolerance.mean);
    EXPECT_LT(error.most, tolerance.most);
    EXPECT_LT(error.worst, tolerance.worst);
    EXPECT_LT(error.open_mean, tolerance.open_mean);
  }
}

// The result does not depend on the resolution, because the radius is in millimetres.
TEST_P(OcclusionReference, IsIndependentOfTheResolution) {
  const auto hidden = [this](int size, float radius_mm) {
    const Image image = Draw(size, radius_mm);
    double sum = 0.0;
    for (const std::uint8_t value : image.rgb) sum += 1.0 - value / 255.0;
    return sum / static_cast<double>(image.rgb.size());
  };
  const float radius_mm = GetParam().looks.back().radius_mm;
  const double small = hidden(kOcclusionSize, radius_mm);
  EXPECT_GT(small, 0.015);
  EXPECT_NEAR(hidden(2 * kOcclusionSize, radius_mm), small, 0.0035);
  EXPECT_NEAR(hidden(4 * kOcclusionSize, radius_mm), small, 0.0035);
}

constexpr auto kGtao = OcclusionMethod::kGtao;
constexpr auto kSsao = OcclusionMethod::kSsao;

INSTANTIATE_TEST_SUITE_P(
    Methods, OcclusionReference,
    testing::Values(Case{"gtao_dome", Fine(kGtao), kDome, kFar, {0.02, 0.05, 0.15, 0.02}},
                    Case{"gtao_ball", Fine(kGtao), kBall, kFar, {0.03, 0.11, 0.45, 0.02}},
                    Case{"gtao_dome_near", Fine(kGtao), kDome, kNear, {0.018, 0.06, 0.1, 0.02}},
                    Case{"gtao_ball_near", Fine(kGtao), kBall, kNear, {0.055, 0.17, 0.45, 0.025}},
                    Case{"gtao_dome_defaults", {}, kDome, kFar, {0.03, 0.07, 0.2, 0.03}},
                    Case{"gtao_ball_defaults", {}, kBall, kFar, {0.04, 0.15, 0.45, 0.03}},
                    Case{"gtao_dome_defaults_near", {}, kDome, kNear, {0.025, 0.07, 0.15, 0.03}},
                    Case{"gtao_ball_defaults_near", {}, kBall, kNear, {0.065, 0.19, 0.5, 0.03}},
                    Case{"ssao_dome", Fine(kSsao), kDome, kFar, {0.03, 0.12, 0.25, 0.02}},
                    Case{"ssao_ball", Fine(kSsao), kBall, kFar, {0.03, 0.12, 0.4, 0.02}}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace furrow::render
