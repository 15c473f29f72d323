// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/oracle/incongruence.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace furrow::wrinkle {
namespace {

TEST(Congruence, LeavesAWeightWithoutOpponentAlone) {
  for (const float own : {0.0f, 1e-6f, 0.3f, 1.0f}) EXPECT_EQ(CongruenceFactor(own, 0.0f), 1.0f);
}

TEST(Congruence, GivesTheWorkedValues) {
  EXPECT_FLOAT_EQ(CongruenceFactor(0.7f, 0.7f), 0.5f);
  EXPECT_NEAR(CongruenceFactor(0.9f, 0.3f), 1.0f, 1e-6f);
  EXPECT_NEAR(CongruenceFactor(0.3f, 0.9f), 0.0f, 1e-6f);
  // (0.5 - 0.3) / 0.8 = 0.25, t = 0.75: 0.5625 * 1.5
  EXPECT_NEAR(CongruenceFactor(0.5f, 0.3f), 0.84375f, 1e-6f);
  EXPECT_NEAR(CongruenceFactor(0.3f, 0.5f), 0.15625f, 1e-6f);
}

TEST(Congruence, AtMostOneOfAPairStaysAboveHalf) {
  for (int i = 0; i <= 100; ++i) {
    for (int k = 0; k <= 100; ++k) {
      const float a = static_cast<float>(i) / 100.0f;
      const float b = static_cast<float>(k) / 100.0f;
      const float left_of_a = a * CongruenceFactor(a, b);
      const float left_of_b = b * CongruenceFactor(b, a);
      EXPECT_LE(std::min(left_of_a, left_of_b), 0.5f + 1e-6f);
      EXPECT_LE(left_of_a, a);
      if (a > 0.0f && b > 0.0f) {
        EXPECT_NEAR(CongruenceFactor(a, b) + CongruenceFactor(b, a), 1.0f, 1e-6f);
      }
      const float most = a < b ? 0.5f * a : a;  // the weaker loses at least half
      EXPECT_LE(left_of_a, most + 1e-6f);
    }
  }
}

TEST(Congruence, IsContinuousDownToNothing) {
  float worst = 0.0f;
  for (int k = 0; k <= 10; ++k) {
    const float b = static_cast<float>(k) / 10.0f;
    for (int i = 0; i < 1000; ++i) {
      const float a = static_cast<float>(i) / 1000.0f;
      const float next = a + 1e-3f;
      worst =
          std::max(worst, std::abs(next * CongruenceFactor(next, b) - a * CongruenceFactor(a, b)));
      worst = std::max(worst, std::abs(b * CongruenceFactor(b, next) - b * CongruenceFactor(b, a)));
    }
  }
  EXPECT_LT(worst, 2.5e-3f);  // steps of 1e-3
}

}  // namespace
}  // namespace furrow::wrinkle
