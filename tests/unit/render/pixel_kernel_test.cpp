// SPDX-License-Identifier: Apache-2.0
#include "render/pixel_kernel.h"

#include <cmath>

#include <gtest/gtest.h>

namespace furrow::render {
namespace {

// Sum and variance (pixels^2) of a kernel given by one side.
struct Moments {
  glm::dvec3 sum{0.0};
  glm::dvec3 variance{0.0};
};

Moments MomentsOf(const std::vector<glm::vec4>& kernel) {
  Moments moments;
  for (std::size_t i = 0; i < kernel.size(); ++i) {
    const double sides = i == 0 ? 1.0 : 2.0;
    const double x = kernel[i].w;
    moments.sum += sides * glm::dvec3(kernel[i]);
    moments.variance += sides * x * x * glm::dvec3(kernel[i]);
  }
  return moments;
}

TEST(PixelKernel, SumsToOneOnWholePixelsOfTheirOwn) {
  for (const int taps : {11, 17, 25}) {
    for (const float pixels_per_mm : {0.05f, 0.3f, 1.0f, 2.4f, 8.0f, 40.0f}) {
      const std::vector<glm::vec4> kernel = PixelKernel(HumanSkin(), taps, pixels_per_mm);
      ASSERT_FALSE(kernel.empty());
      EXPECT_LE(2 * kernel.size() - 1, static_cast<std::size_t>(taps));
      const Moments moments = MomentsOf(kernel);
      for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(moments.sum[channel], 1.0, 1e-5) << taps << " " << pixels_per_mm;
      }
      EXPECT_EQ(kernel[0].w, 0.0f);
      for (std::size_t i = 1; i < kernel.size(); ++i) {
        EXPECT_GT(kernel[i].w, kernel[i - 1].w);
        EXPECT_EQ(kernel[i].w, std::round(kernel[i].w));
      }
    }
  }
}

TEST(PixelKernel, GetsShortWhereAPixelIsWide) {
  EXPECT_EQ(PixelKernel(HumanSkin(), 17, 0.01f).size(), 1u);
  EXPECT_LT(PixelKernel(HumanSkin(), 17, 0.5f).size(), 9u);
  EXPECT_EQ(PixelKernel(HumanSkin(), 17, 5.0f).size(), 9u);
}

// A straight edge through a kernel of all pixels within reach is the exact response.
TEST(PixelKernel, AnEdgeKeepsItsResponse) {
  const float pixels_per_mm = 2.0f;
  const std::vector<glm::vec4> kernel = PixelKernel(HumanSkin(), 17, pixels_per_mm);
  for (std::size_t i = 0; i + 1 < kernel.size(); ++i) {
    // Lit from just beyond the border after tap i: what all further taps of one side see.
    glm::vec3 lit(0.0f);
    for (std::size_t k = i + 1; k < kernel.size(); ++k) lit += glm::vec3(kernel[k]);
    const float border = 0.5f * (kernel[i].w + kernel[i + 1].w) / pixels_per_mm;
    const glm::vec3 exact = glm::vec3(1.0f) - StepResponse(HumanSkin(), border);
    for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(lit[channel], exact[channel], 2e-3);
  }
}

TEST(PixelGaussian, HasTheVarianceThatIsAskedFor) {
  EXPECT_EQ(PixelGaussian(0.2f).size(), 1u);
  for (const float sigma : {0.4f, 0.7f, 1.0f, 1.5f, 3.0f, 11.0f}) {
    const Moments moments = MomentsOf(PixelGaussian(sigma));
    EXPECT_NEAR(moments.sum.r, 1.0, 1e-5) << sigma;
    EXPECT_NEAR(moments.variance.r, sigma * sigma, 1e-3 * sigma * sigma) << sigma;
    for (const glm::vec4& tap : PixelGaussian(sigma)) EXPECT_GE(tap.r, 0.0f) << sigma;
  }
}

}  // namespace
}  // namespace furrow::render
