// SPDX-License-Identifier: Apache-2.0
// Wrinkles change normals only, and ambient occlusion must still respond to them.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "render/renderer.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

constexpr int kFoldSize = 128;
constexpr float kFoldHalfWidth = 0.02f;  // of the texture; 40 mm

float Flat(float, float) { return 0.0f; }

// A fold along v with flanks of 60 degrees.
float DeepFold(float u, float) {
  const float slope = std::sqrt(3.0f);
  return slope * std::min(std::abs(u - 0.5f) - kFoldHalfWidth, 0.0f);
}

class OcclusionNormals : public testing::TestWithParam<OcclusionSettings> {
 protected:
  // Draws openness, [0, 1], in a picture 160 mm wide.
  [[nodiscard]] static Image Draw(const character::Character& plane, float wrinkle_weight) {
    const std::unique_ptr<Renderer> renderer = test::Expect(Renderer::Create(plane));
    test::Subject subject(plane);
    subject.Set("r0", wrinkle_weight);
    subject.Solve();
    FrameRequest request;
    request.model = subject.model;
    request.binding = &subject.binding;
    request.wrinkle_weights = subject.weights;
    request.filtered_values = subject.driver_values;
    request.camera.position = {0.0f, 0.0f, 0.5f};
    request.camera.target = {0.0f, 0.0f, 0.0f};
    request.camera.fov_y_degrees = 18.18f;
    request.width = request.height = kFoldSize;
    request.settings.view = View::kOcclusion;
    request.settings.occlusion = GetParam();
    request.settings.anti_aliasing.samples = 1;
    return test::Expect(renderer->Render(request));
  }
  // Mean over the columns [from, to), in millimetres from the picture's centre.
  [[nodiscard]] static double Open(const Image& image, double from_mm, double to_mm) {
    const auto column = [](double mm) { return static_cast<int>(kFoldSize * (0.5 + mm / 160.0)); };
    double sum = 0.0;
    int pixels = 0;
    for (int y = 0; y < kFoldSize; ++y) {
      for (int x = column(from_mm); x < column(to_mm); ++x, ++pixels) {
        sum += image.rgb[static_cast<std::size_t>(3 * (y * kFoldSize + x))] / 255.0;
      }
    }
    return sum / pixels;
  }
};

// Above a flat surface, a normal tilted by an angle a sees (1 + cos a) / 2 of its sky.
TEST_P(OcclusionNormals, TheFlanksOfAFoldSeeLessSky) {
  const character::Character plane = test::MakePlane(512, Flat, {DeepFold});
  const Image folded = Draw(plane, 1.0f);
  EXPECT_NEAR(Open(folded, -32.0, -8.0), 0.75, 0.03);
  EXPECT_NEAR(Open(folded, 8.0, 32.0), 0.75, 0.03);
  EXPECT_GT(Open(folded, -75.0, -48.0), 0.97);
  EXPECT_GT(Open(folded, 48.0, 75.0), 0.97);
  // At half the weight, the slope is halved to 40.9 degrees.
  EXPECT_NEAR(Open(Draw(plane, 0.5f), 8.0, 32.0), 0.878, 0.03);
}

TEST_P(OcclusionNormals, AFoldOfWeight0OccludesNothing) {
  const Image at_rest = Draw(test::MakePlane(512, Flat, {DeepFold}), 0.0f);
  EXPECT_EQ(at_rest.rgb, Draw(test::MakePlane(512, Flat, {Flat}), 1.0f).rgb);
  EXPECT_GT(Open(at_rest, -75.0, 75.0), 0.97);
}

OcclusionSettings Fine() {
  OcclusionSettings settings;
  settings.half_resolution = false;
  settings.samples = 32;
  return settings;
}

INSTANTIATE_TEST_SUITE_P(Settings, OcclusionNormals, testing::Values(OcclusionSettings{}, Fine()),
                         [](const auto& tested) {
                           return std::string(tested.param.half_resolution ? "defaults" : "fine");
                         });

}  // namespace
}  // namespace furrow::render
