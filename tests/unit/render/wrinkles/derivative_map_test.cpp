// SPDX-License-Identifier: Apache-2.0
#include "render/wrinkles/derivative_map.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

TEST(DerivativeMap, OfANormalMapIsTheNegativeGradientOfItsHeights) {
  constexpr int kSize = 64;
  // h = 0.02 sin(2 pi (u + 2 v)). y is up in the picture, so d/dy = -d/dv.
  const auto height = [](float u, float v) { return 0.02f * std::sin(6.2831853f * (u + 2 * v)); };
  const DerivativeMap map = DerivativesFromNormalMap(test::NormalMapOf("n", kSize, height));
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const double phase = 6.283185307 * ((x + 0.5) / kSize + 2 * (y + 0.5) / kSize);
      const double slope = 0.02 * 6.283185307 * std::cos(phase);
      const std::size_t texel = 2 * static_cast<std::size_t>(y * kSize + x);
      ASSERT_NEAR(map.texels[texel], -slope, 2e-4);
      ASSERT_NEAR(map.texels[texel + 1], 2 * slope, 2e-4);
    }
  }
}

TEST(DerivativeMap, GreenAboveTheMiddleLeansUp) {
  character::Picture picture{"n", 1, 1, 3, {128, 200, 220}, {}};
  const DerivativeMap map = DerivativesFromNormalMap(picture);
  EXPECT_NEAR(map.texels[0], 0.0, 0.01);
  EXPECT_NEAR(map.texels[1], (200 / 127.5 - 1) / (220 / 127.5 - 1), 1e-4);
}

TEST(DerivativeMap, NormalsBelowTheHorizonAreClamped) {
  character::Picture picture{"n", 1, 1, 3, {255, 0, 0}, {}};
  const DerivativeMap map = DerivativesFromNormalMap(picture);
  EXPECT_EQ(map.texels[0], kMaxDerivative);
  EXPECT_EQ(map.texels[1], -kMaxDerivative);
}

TEST(DerivativeMap, OfADerivativeMapSpansMinusOneToOne) {
  character::Picture picture{"d", 3, 1, 2, {}, {0, 65535, 65535, 0, 32768, 16384}};
  const DerivativeMap map = DerivativesFromDerivativeMap(picture);
  const std::vector<float> expected = {-1.0f, 1.0f, 1.0f, -1.0f, 0.0f, -0.5f};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(map.texels[i], expected[i], 1e-4);
}

TEST(DerivativeMap, TheScaleAppliesToIntegersOnly) {
  character::Picture integers;
  integers.width = 1;
  integers.height = 1;
  integers.channels = 2;
  integers.pixels16 = {65535, 16384};
  const DerivativeMap scaled = DerivativesFromDerivativeMap(integers, 3.0f);
  EXPECT_NEAR(scaled.texels[0], 3.0f, 1e-4f);
  EXPECT_NEAR(scaled.texels[1], -1.5f, 1e-3f);
  character::Picture floats = integers;
  floats.pixels16.clear();
  floats.pixels_float = {-2.25f, 100.0f};
  const DerivativeMap plain = DerivativesFromDerivativeMap(floats, 3.0f);
  EXPECT_EQ(plain.texels[0], -2.25f);
  EXPECT_EQ(plain.texels[1], kMaxDerivative);
}

TEST(DerivativeMap, ResampleKeepsARampAndClampsAtTheEdges) {
  DerivativeMap ramp{4, 1, {0, 0, 1, 10, 2, 20, 3, 30}};
  const DerivativeMap twice = Resample(ramp, 8, 1);
  const std::vector<float> expected = {0, 0.25, 0.75, 1.25, 1.75, 2.25, 2.75, 3};
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(twice.texels[2 * i], expected[i], 1e-6);
    EXPECT_NEAR(twice.texels[2 * i + 1], 10 * expected[i], 1e-5);
  }
}

TEST(ToRgba8, SpreadsGreyAndFillsAlpha) {
  EXPECT_EQ(ToRgba8({"g", 1, 1, 1, {7}, {}}), (std::vector<std::uint8_t>{7, 7, 7, 255}));
  EXPECT_EQ(ToRgba8({"ga", 1, 1, 2, {7, 9}, {}}), (std::vector<std::uint8_t>{7, 7, 7, 9}));
  EXPECT_EQ(ToRgba8({"rgb", 1, 1, 3, {1, 2, 3}, {}}), (std::vector<std::uint8_t>{1, 2, 3, 255}));
  EXPECT_EQ(ToRgba8({"16", 1, 1, 4, {}, {65535, 0, 257, 514}}),
            (std::vector<std::uint8_t>{255, 0, 1, 2}));
}

}  // namespace
}  // namespace furrow::render
