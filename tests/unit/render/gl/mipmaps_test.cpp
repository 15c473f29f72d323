// SPDX-License-Identifier: Apache-2.0
#include "render/gl/mipmaps.h"

#include <gtest/gtest.h>

namespace furrow::render::gl {
namespace {

TEST(Mipmaps, LinearValuesAreAveraged) {
  const std::vector<std::uint8_t> texels = {0, 10, 20, 255, 4, 10, 20, 255,
                                            8, 10, 20, 0,   8, 10, 21, 0};
  EXPECT_EQ(HalfSize(texels, 2, 2, MipSpace::kLinear), (std::vector<std::uint8_t>{5, 10, 20, 128}));
}

// A quarter of the light of white is 137 of 255 (IEC 61966-2-1). Alpha is linear.
TEST(Mipmaps, SrgbIsAveragedAsLight) {
  const std::vector<std::uint8_t> texels = {0, 0, 0, 0, 255, 255, 255, 255, 0, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(HalfSize(texels, 2, 2, MipSpace::kSrgb),
            (std::vector<std::uint8_t>{137, 137, 137, 64}));
}

TEST(Mipmaps, AUniformColourStaysAsItIs) {
  for (int value = 0; value < 256; ++value) {
    const std::vector<std::uint8_t> texels(16, static_cast<std::uint8_t>(value));
    EXPECT_EQ(HalfSize(texels, 2, 2, MipSpace::kSrgb),
              std::vector<std::uint8_t>(4, static_cast<std::uint8_t>(value)));
  }
}

TEST(Mipmaps, OddAndNarrowSidesAreHalved) {
  const std::vector<float> texels = {1, 3, 100, 5, 7, 100, 100, 100, 100};
  EXPECT_EQ(HalfSize(texels, 3, 3, 1), std::vector<float>{4});
  EXPECT_EQ(HalfSize({1, 3, 5, 9}, 1, 4, 1), (std::vector<float>{2, 7}));
  EXPECT_EQ(HalfSize({1, 3, 5, 9}, 1, 1, 4), (std::vector<float>{1, 3, 5, 9}));
}

}  // namespace
}  // namespace furrow::render::gl
