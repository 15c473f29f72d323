// SPDX-License-Identifier: Apache-2.0
#include "base/srgb.h"

#include <gtest/gtest.h>

namespace furrow {
namespace {

// Values of IEC 61966-2-1: middle grey, and the end of the straight part.
TEST(Srgb, HasTheValuesOfTheStandard) {
  EXPECT_EQ(LinearFromSrgb(0.0f), 0.0f);
  EXPECT_FLOAT_EQ(LinearFromSrgb(1.0f), 1.0f);
  EXPECT_NEAR(LinearFromSrgb(0.5f), 0.214041f, 1e-6f);
  EXPECT_NEAR(LinearFromSrgb(0.04045f), 0.00313080f, 1e-8f);
}

TEST(Srgb, BothWaysCancelOut) {
  for (int i = 0; i <= 255; ++i) {
    const float value = static_cast<float>(i) / 255.0f;
    EXPECT_NEAR(SrgbFromLinear(LinearFromSrgb(value)), value, 1e-6f) << i;
  }
}

}  // namespace
}  // namespace furrow
