// SPDX-License-Identifier: Apache-2.0
#include "render/wrinkles/half_floats.h"

#include <cmath>
#include <limits>
#include <vector>

#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>

namespace furrow::render {
namespace {

// GLM's conversions are scalar and independent.
TEST(HalfFloatsTest, AllBitsAreDecoded) {
  std::vector<std::uint16_t> halves;
  for (std::uint32_t bits = 0; bits < 65536; ++bits) {
    halves.push_back(static_cast<std::uint16_t>(bits));
  }
  std::vector<float> floats(halves.size());
  FromHalfFloats(halves, floats);
  for (std::size_t i = 0; i < halves.size(); ++i) {
    const float expected = glm::unpackHalf1x16(halves[i]);
    if (std::isnan(expected)) {
      EXPECT_TRUE(std::isnan(floats[i])) << i;
    } else {
      EXPECT_EQ(floats[i], expected) << i;
    }
  }
}

TEST(HalfFloatsTest, TheNearestHalfIsEncoded) {
  EXPECT_EQ(glm::packHalf1x16(1.0f), 0x3c00);
  const std::vector<float> floats = {0.0f,
                                     -1.0f,
                                     0.5f,
                                     16.0f,
                                     65504.0f,
                                     1.00048f,  // just below the middle of 1 and the next half
                                     1.00049f,  // just above it
                                     1.00048828125f,  // the middle: to the even one
                                     5.9604645e-8f,   // the smallest subnormal half
                                     std::numeric_limits<float>::infinity()};
  const std::vector<std::uint16_t> expected = {0x0000, 0xbc00, 0x3800, 0x4c00, 0x7bff,
                                               0x3c00, 0x3c01, 0x3c00, 0x0001, 0x7c00};
  std::vector<std::uint16_t> halves(floats.size());
  ToHalfFloats(floats, halves);
  EXPECT_EQ(halves, expected);
}

// Any length, also one that does not fill the last vector, and no write beyond the end.
TEST(HalfFloatsTest, EveryLengthIsConvertedExactly) {
  for (std::size_t length = 0; length < 40; ++length) {
    std::vector<float> floats(length + 1, -2.0f);
    for (std::size_t i = 0; i < length; ++i) floats[i] = static_cast<float>(i);
    std::vector<std::uint16_t> halves(length + 1, 0x1234);
    ToHalfFloats(std::span(floats).first(length), std::span(halves).first(length));
    EXPECT_EQ(halves[length], 0x1234);
    std::vector<float> back(length + 1, -3.0f);
    FromHalfFloats(std::span(halves).first(length), std::span(back).first(length));
    EXPECT_EQ(back[length], -3.0f);
    for (std::size_t i = 0; i < length; ++i) EXPECT_EQ(back[i], floats[i]);
  }
}

}  // namespace
}  // namespace furrow::render
