// SPDX-License-Identifier: Apache-2.0
#include "render/skin/skin_profile.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

namespace furrow::render {
namespace {

// Integral of `f` over [low, high] by the midpoint rule.
double Integrate(const std::function<double(double)>& f, double low, double high, int steps) {
  double sum = 0.0;
  const double width = (high - low) / steps;
  for (int i = 0; i < steps; ++i) sum += f(low + (i + 0.5) * width);
  return sum * width;
}

TEST(SkinProfile, EveryChannelConservesLight) {
  for (int channel = 0; channel < 3; ++channel) {
    float sum = 0.0f;
    for (const SkinGaussian& gaussian : HumanSkin()) sum += gaussian.weight[channel];
    EXPECT_NEAR(sum, 1.0f, 1e-6f) << channel;
    const double area = Integrate(
        [&](double r) {
          return 2.0 * std::numbers::pi * r * RadialProfile(HumanSkin(), r)[channel];
        },
        0.0, 20.0, 20000);
    EXPECT_NEAR(area, 1.0, 1e-4) << channel;
  }
}

// sum_i w_i v_i of GPU Gems 3's table 14-1, calculated by hand.
TEST(SkinProfile, SpreadsRedFarthest) {
  const double expected[3] = {1.38287, 0.06813, 0.02477};
  for (int channel = 0; channel < 3; ++channel) {
    const double variance = Integrate(
        [&](double x) { return x * x * LineProfile(HumanSkin(), x)[channel]; }, -20.0, 20.0, 40000);
    EXPECT_NEAR(variance, expected[channel], 1e-4) << channel;
  }
}

TEST(SkinProfile, LineProfileIsTheIntegralOfTheRadialProfile) {
  for (const double x : {0.0, 0.3, 1.0, 2.5}) {
    for (int channel = 0; channel < 3; ++channel) {
      const double line =
          Integrate([&](double y) { return RadialProfile(HumanSkin(), std::hypot(x, y))[channel]; },
                    -20.0, 20.0, 40000);
      EXPECT_NEAR(LineProfile(HumanSkin(), x)[channel], line, 1e-4 * (1.0 + line)) << x;
    }
  }
}

// sum_i w_i Phi(x / sigma_i), from a table of the normal distribution.
TEST(SkinProfile, StepResponseOneMillimetreInsideIsRed0875) {
  const glm::vec3 inside = StepResponse(HumanSkin(), 1.0);
  EXPECT_NEAR(inside.r, 0.87492f, 1e-4f);
  EXPECT_NEAR(inside.g, 0.99634f, 1e-4f);
  EXPECT_NEAR(inside.b, 0.99935f, 1e-4f);
  const glm::vec3 outside = StepResponse(HumanSkin(), -1.0);
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(outside[channel], 1.0f - inside[channel], 1e-6f);
    EXPECT_NEAR(StepResponse(HumanSkin(), 0.0)[channel], 0.5f, 1e-6f);
  }
}

TEST(SkinProfile, ShareWithinIsTheIntegralOfTheProfile) {
  for (const double r : {0.1, 0.5, 2.0}) {
    for (int channel = 0; channel < 3; ++channel) {
      const double share = Integrate(
          [&](double s) {
            return 2.0 * std::numbers::pi * s * RadialProfile(HumanSkin(), s)[channel];
          },
          0.0, r, 4000);
      EXPECT_NEAR(RadialShare(HumanSkin(), r)[channel], share, 1e-4) << r;
    }
  }
}

// Square roots of the differences of variance: sqrt(0.0484 - 0.0064) = 0.205, and so on.
TEST(SkinProfile, CascadedBlursAddUpToTheVariances) {
  const auto sigmas = CascadedSigmas(HumanSkin());
  const float expected[kNumSkinGaussians] = {0.080f, 0.205f, 0.372f, 0.616f, 1.193f, 2.328f};
  float variance = 0.0f;
  for (std::size_t i = 0; i < sigmas.size(); ++i) {
    EXPECT_NEAR(sigmas[i], expected[i], 1e-3f) << i;
    variance += sigmas[i] * sigmas[i];
    EXPECT_NEAR(variance, HumanSkin()[i].variance, 1e-5f) << i;
  }
}

TEST(SkinProfile, ThinSkinTransmitsMostlyRed) {
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(Transmittance(HumanSkin(), 0.0)[channel], 1.0f, 1e-6f);
  }
  // 0.358 exp(-4 / 1.99) + 0.078 exp(-4 / 7.41) + 0.113 exp(-4 / 0.567).
  EXPECT_NEAR(Transmittance(HumanSkin(), 2.0).r, 0.09352f, 1e-4f);
  EXPECT_LT(Transmittance(HumanSkin(), 2.0).b, 1e-4f);
}

TEST(Burley, ConservesLightAndItsShareIsItsIntegral) {
  for (const double d : {0.1, 0.5}) {
    for (const double r : {0.2, 1.0, 5.0}) {
      const double share =
          Integrate([&](double s) { return 2.0 * std::numbers::pi * s * BurleyProfile(d, s); }, 0.0,
                    r, 20000);
      EXPECT_NEAR(BurleyShare(d, r), share, 1e-5);
    }
    EXPECT_NEAR(BurleyShare(d, 100.0), 1.0, 1e-9);
  }
}

TEST(Burley, RadiusInvertsTheShare) {
  EXPECT_EQ(BurleyRadius(0.4, 0.0), 0.0);
  for (double share = 0.01; share < 1.0; share += 0.01) {
    EXPECT_NEAR(BurleyShare(0.4, BurleyRadius(0.4, share)), share, 1e-9);
  }
  EXPECT_TRUE(std::isfinite(BurleyRadius(0.4, 1.0)));
}

// One parameter per channel cannot fit better. The six Gaussians are narrower in the centre, where
// Burley's profile is infinite, and equally wide in the tail.
TEST(Burley, FitIsCloseToSkin) {
  const glm::vec3 d = FitBurley(HumanSkin());
  EXPECT_GT(d.r, d.g);
  EXPECT_GT(d.g, d.b);
  const double limits[3] = {0.08, 0.10, 0.14};
  for (int channel = 0; channel < 3; ++channel) {
    double worst = 0.0;
    for (double r = 0.05; r < 8.0; r *= 1.1) {
      const double skin = RadialShare(HumanSkin(), r)[channel];
      worst = std::max(worst, std::abs(BurleyShare(d[channel], r) - skin));
    }
    EXPECT_LT(worst, limits[channel]) << channel;
    printf("burley: channel %d, d = %.4f mm, worst share error %.3f\n", channel, d[channel], worst);
  }
}

}  // namespace
}  // namespace furrow::render
