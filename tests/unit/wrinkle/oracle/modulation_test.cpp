// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/oracle/modulation.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace furrow::wrinkle {
namespace {

constexpr Modulation kAll[] = {Modulation::kLinear, Modulation::kCosine, Modulation::kCubic};

TEST(Modulation, CosinePassesThroughItsPoints) {
  EXPECT_NEAR(CosineModulation(0.0f), 0.0f, 1e-7f);
  EXPECT_NEAR(CosineModulation(0.5f), 0.5f, 1e-6f);
  EXPECT_NEAR(CosineModulation(1.0f), 1.0f, 1e-7f);
  EXPECT_NEAR(CosineModulation(0.25f), 0.1464466f, 1e-6f);  // (1 - sqrt(1/2)) / 2
}

TEST(Modulation, CosineEqualsThePrintedForm) {
  for (int i = 0; i <= 100; ++i) {
    const double x = i / 100.0;
    const double printed = (std::cos(3.14159265358979 * (1.0 + x)) + 1.0) / 2.0;
    EXPECT_NEAR(CosineModulation(static_cast<float>(x)), printed, 1e-6);
  }
}

TEST(Modulation, CosineHasNoSlopeAtItsEnds) {
  EXPECT_LT(CosineModulation(1e-3f), 1e-5f);
  EXPECT_GT(CosineModulation(1.0f - 1e-3f), 1.0f - 1e-5f);
}

TEST(Modulation, CubicAsPrintedLeavesTheRange) {
  EXPECT_NEAR(CubicModulation(1.0f), 1.0063f, 1e-5f);
  EXPECT_EQ(CubicModulation(0.0f), 0.0f);
  EXPECT_NEAR(CubicModulation(1e-3f) / 1e-3f, 2.62235f, 0.006f);
  // 1.311175 - 1.2194325 + 0.40771
  EXPECT_NEAR(CubicModulation(0.5f), 0.4994525f, 1e-6f);
}

// 3 a x^2 + 2 b x + c has its vertex at x = 4.87773 / (3 * 3.26168) = 0.49849; the slope there is
// 2.62235 - 4.87773^2 / (3 * 3.26168) = 0.19085: a plateau, and no second peak.
TEST(Modulation, CubicHasAPlateauAndNoPeaks) {
  float least_slope = 10.0f;
  for (int i = 0; i < 1000; ++i) {
    const float x = static_cast<float>(i) / 1000.0f;
    const float slope = (CubicModulation(x + 1e-3f) - CubicModulation(x)) / 1e-3f;
    least_slope = std::min(least_slope, slope);
  }
  EXPECT_NEAR(least_slope, 0.19085f, 2e-3f);
}

TEST(Modulation, ClampsInputAndOutput) {
  for (const Modulation modulation : kAll) {
    EXPECT_EQ(Modulate(modulation, -3.0f), 0.0f);
    EXPECT_EQ(Modulate(modulation, 0.0f), 0.0f);
    EXPECT_NEAR(Modulate(modulation, 1.0f), 1.0f, 1e-6f);
    EXPECT_NEAR(Modulate(modulation, 7.0f), 1.0f, 1e-6f);
    EXPECT_EQ(Modulate(modulation, std::numeric_limits<float>::quiet_NaN()), 0.0f);
  }
  EXPECT_EQ(Modulate(Modulation::kCubic, 1.0f), 1.0f);
}

TEST(Modulation, RisesWithItsInput) {
  for (const Modulation modulation : kAll) {
    for (int i = 0; i < 1000; ++i) {
      const float x = static_cast<float>(i) / 1000.0f;
      EXPECT_LE(Modulate(modulation, x), Modulate(modulation, x + 1e-3f));
    }
  }
}

}  // namespace
}  // namespace furrow::wrinkle
