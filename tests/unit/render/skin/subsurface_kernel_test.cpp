// SPDX-License-Identifier: Apache-2.0
#include "render/skin/subsurface_kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace furrow::render {
namespace {

template <class Tap>
glm::vec3 Sum(const std::vector<Tap>& taps) {
  glm::vec3 sum(0.0f);
  for (const Tap& tap : taps) sum += tap.weight;
  return sum;
}

TEST(BurleyDisc, IsNormalisedWithExactRingWeights) {
  const glm::vec3 d(0.4f, 0.15f, 0.08f);
  for (const int taps : {1, 16, 64}) {
    const std::vector<DiscTap> disc = BurleyDisc(d, taps);
    ASSERT_EQ(disc.size(), static_cast<std::size_t>(taps));
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(Sum(disc)[channel], 1.0f, 1e-5f);
    }
  }
  // Importance sampling by red: each ring holds the same share of red.
  for (const DiscTap& tap : BurleyDisc(d, 16)) EXPECT_NEAR(tap.weight.r, 1.0f / 16, 1e-5f);
}

TEST(BurleyDisc, IsBalancedAroundItsCentre) {
  glm::vec2 mean(0.0f);
  for (const DiscTap& tap : BurleyDisc(glm::vec3(0.4f), 48)) mean += tap.offset * tap.weight.r;
  EXPECT_LT(std::hypot(mean.x, mean.y), 0.1f);
}

// Without curvature, the response is the clamped cosine of the light.
TEST(SphereResponse, WithoutCurvatureIsLambert) {
  for (const double cosine : {-0.5, 0.0, 0.3, 1.0}) {
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(SphereResponse(HumanSkin(), cosine, 0.0)[channel], std::max(cosine, 0.0), 2e-4);
    }
  }
}

// Diffusion moves light and creates none: the mean over the whole sphere stays 1/4.
TEST(SphereResponse, ConservesLight) {
  for (const double curvature : {0.05, 0.2, 0.5}) {
    glm::dvec3 sum(0.0);
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i) {
      sum += glm::dvec3(SphereResponse(HumanSkin(), 2.0 * (i + 0.5) / kSteps - 1.0, curvature));
    }
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(sum[channel] / kSteps, 0.25, 5e-4) << curvature;
    }
  }
}

// Brute force: points distributed evenly over a sphere, weighted by the profile of their chord.
TEST(SphereResponse, MatchesASumOverTheSphere) {
  constexpr int kPoints = 400000;
  constexpr double kRadius = 4.0;  // mm
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (const double cosine : {-0.2, 0.1, 0.8}) {
    const double sine = std::sqrt(1.0 - cosine * cosine);
    glm::dvec3 light(0.0);
    glm::dvec3 whole(0.0);
    for (int i = 0; i < kPoints; ++i) {
      const double z = 1.0 - 2.0 * (i + 0.5) / kPoints;  // the point of interest is at z = 1
      const double x = std::sqrt(1.0 - z * z) * std::cos(golden_angle * i);
      const double chord = kRadius * std::sqrt(2.0 - 2.0 * z);
      const glm::dvec3 weight(RadialProfile(HumanSkin(), chord));
      light += weight * std::max(0.0, cosine * z + sine * x);
      whole += weight;
    }
    const glm::vec3 response = SphereResponse(HumanSkin(), cosine, 1.0 / kRadius);
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(response[channel], light[channel] / whole[channel], 2e-3) << cosine;
    }
  }
}

TEST(PreintegratedTable, CoversBothRangesToTheirEnds) {
  const std::vector<glm::vec3> table = PreintegratedTable(HumanSkin(), 8);
  ASSERT_EQ(table.size(), 64u);
  EXPECT_NEAR(table[7].r, 1.0f, 1e-3f);  // flat, facing the light
  EXPECT_NEAR(table[0].r, 0.0f, 1e-6f);  // flat, facing away
  EXPECT_EQ(table[56 + 4], SphereResponse(HumanSkin(), 1.0 / 7.0, kMaxCurvature));
  EXPECT_GT(table[56 + 3].r, table[56 + 3].b);  // red light reaches beyond the terminator
}

}  // namespace
}  // namespace furrow::render
