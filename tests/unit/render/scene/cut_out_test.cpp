// SPDX-License-Identifier: Apache-2.0
// Materials cut out by the alpha of their base colour: hair, lashes.
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "render/renderer.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

// A plane of vertical stripes, alternately opaque and cut out.
class CutOutTest : public testing::Test {
 protected:
  static constexpr int kTexels = 256;
  static constexpr float kStripes = 32.0f;

  void Make(float alpha_cutoff) {
    const auto flat = [](float, float) { return 0.0f; };
    plane_ = test::MakePlane(16, flat, {flat});
    plane_.pictures.push_back(test::MakePicture("stripes", kTexels, [](float u, float) {
      const float wave = std::sin(2.0f * 3.14159265f * kStripes * u);
      return glm::vec4(glm::vec3(1.0f), wave > 0.0f ? 1.0f : 0.0f);
    }));
    plane_.materials[0].base_colour_texture = static_cast<int>(plane_.pictures.size()) - 1;
    plane_.materials[0].alpha_cutoff = alpha_cutoff;
    subject_ = std::make_unique<test::Subject>(plane_);
    renderer_ = test::Expect(Renderer::Create(plane_));
  }
  Image Draw(int size, int samples) {
    FrameRequest request;
    request.model = subject_->model;
    request.binding = &subject_->binding;
    request.wrinkle_weights = subject_->weights;
    request.filtered_values = subject_->driver_values;
    request.camera = *renderer_->Preset("face");
    request.width = request.height = size;
    request.settings.view = View::kAlbedo;
    request.settings.shading = Shading::kSkin;
    request.settings.anti_aliasing.samples = samples;
    return test::Expect(renderer_->Render(request));
  }
  // Total light of the red channel.
  static double Sum(const Image& image) {
    double sum = 0.0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
      const double value = image.rgb[i] / 255.0;  // sRGB
      sum += std::pow(value, 2.2);
    }
    return sum;
  }

  character::Character plane_;
  std::unique_ptr<test::Subject> subject_;
  std::unique_ptr<Renderer> renderer_;
};

// Half of the surface is visible, whether a pixel covers part of a stripe or many stripes.
TEST_F(CutOutTest, CoverageIsTheSameFromNearAndFar) {
  constexpr int kSizes[] = {480, 240, 120, 60, 30, 20};
  std::vector<double> whole;
  Make(0.0f);
  for (const int size : kSizes) whole.push_back(Sum(Draw(size, 4)));
  Make(0.4f);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    ASSERT_GT(whole[i], 0.0);
    EXPECT_NEAR(Sum(Draw(kSizes[i], 4)) / whole[i], 0.5, 0.08) << kSizes[i];
  }
}

// If stripes are a few pixels wide, the pixels on their edges are partly covered.
TEST_F(CutOutTest, EdgesAreSmooth) {
  const auto share_between = [](const Image& image) {
    double between = 0.0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
      between += image.rgb[i] > 40 && image.rgb[i] < 215 ? 1.0 : 0.0;
    }
    return 3.0 * between / static_cast<double>(image.rgb.size());
  };
  Make(0.4f);
  EXPECT_GT(share_between(Draw(520, 4)), 0.02);
  EXPECT_LT(share_between(Draw(520, 1)), 0.002);
}

}  // namespace
}  // namespace furrow::render
