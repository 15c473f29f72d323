// SPDX-License-Identifier: Apache-2.0
#include "render/video/planes.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace furrow::render {
namespace {

Image Uniform(int width, int height, std::array<std::uint8_t, 3> colour) {
  Image image{.width = width, .height = height};
  for (int i = 0; i < width * height; ++i) {
    image.rgb.insert(image.rgb.end(), colour.begin(), colour.end());
  }
  return image;
}

// ITU-R BT.601 from its constants, and the limited range of ITU-T H.264, annex E, at 8 bits.
TEST(Planes, ColoursAreThoseOfBt601InLimitedRange) {
  for (const std::array<std::uint8_t, 3> colour :
       {std::array<std::uint8_t, 3>{0, 0, 0}, {255, 255, 255}, {255, 0, 0}, {196, 140, 117}}) {
    Planes planes;
    ASSERT_TRUE(ToPlanes(Uniform(32, 16, colour), &planes).ok());
    const double y = 0.299 * colour[0] + 0.587 * colour[1] + 0.114 * colour[2];
    ASSERT_EQ(planes.y.size(), 32u * 16u);
    ASSERT_EQ(planes.u.size(), 16u * 8u);
    ASSERT_EQ(planes.v.size(), 16u * 8u);
    // Colours of half steps would tint everything alike.
    if (colour[0] == colour[1] && colour[1] == colour[2]) {
      EXPECT_EQ(planes.u[50], 128);
      EXPECT_EQ(planes.v[50], 128);
    }
    EXPECT_NEAR(planes.y[100], 16.0 + 219.0 * y / 255.0, 1.0);
    EXPECT_NEAR(planes.u[50], 128.0 + 224.0 * (colour[2] - y) / 1.772 / 255.0, 1.0);
    EXPECT_NEAR(planes.v[50], 128.0 + 224.0 * (colour[0] - y) / 1.402 / 255.0, 1.0);
  }
}

TEST(Planes, OddSizesRepeatTheirEdge) {
  Image image = Uniform(5, 3, {10, 10, 10});
  for (int y = 0; y < 3; ++y) {  // the last column and row are light
    for (int x = 0; x < 5; ++x) {
      if (x < 4 && y < 2) continue;
      for (int c = 0; c < 3; ++c) image.rgb[static_cast<std::size_t>(3 * (5 * y + x) + c)] = 200;
    }
  }
  Planes planes;
  ASSERT_TRUE(ToPlanes(image, &planes).ok());
  EXPECT_EQ(planes.width, 6);
  EXPECT_EQ(planes.height, 4);
  const std::vector<std::uint8_t> expected = {25,  25,  25,  25,  188, 188,  //
                                              25,  25,  25,  25,  188, 188,  //
                                              188, 188, 188, 188, 188, 188,  //
                                              188, 188, 188, 188, 188, 188};
  EXPECT_EQ(planes.y, expected);
}

TEST(Planes, WrongSizesAreErrors) {
  Planes planes;
  EXPECT_EQ(ToPlanes(Image{}, &planes).code(), StatusCode::kInvalidArgument);
  Image image = Uniform(4, 4, {1, 2, 3});
  image.rgb.pop_back();
  EXPECT_EQ(ToPlanes(image, &planes).code(), StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace furrow::render
