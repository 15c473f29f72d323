// SPDX-License-Identifier: Apache-2.0
#include "character/pictures/picture.h"

#include <gtest/gtest.h>

namespace furrow::character {
namespace {

Picture Grey(int width, int height) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  picture.channels = 1;
  for (int i = 0; i < width * height; ++i) picture.pixels.push_back(static_cast<std::uint8_t>(i));
  return picture;
}

TEST(Picture, ReduceAveragesBlocks) {
  Picture picture = Grey(4, 4);
  Reduce(2, &picture);
  EXPECT_EQ(picture.width, 2);
  EXPECT_EQ(picture.height, 2);
  // The means of 0 1 4 5, 2 3 6 7, 8 9 12 13 and 10 11 14 15 are halves, which are rounded up.
  EXPECT_EQ(picture.pixels, (std::vector<std::uint8_t>{3, 5, 11, 13}));
}

TEST(Picture, ReduceKeepsAtLeastOneRow) {
  Picture picture = Grey(8, 1);
  Reduce(2, &picture);
  EXPECT_EQ(picture.width, 2);
  EXPECT_EQ(picture.height, 1);
  EXPECT_EQ(picture.pixels, (std::vector<std::uint8_t>{2, 6}));
}

TEST(Picture, ReduceLeavesSmallPicturesAlone) {
  Picture picture = Grey(4, 2);
  Reduce(4, &picture);
  EXPECT_EQ(picture.pixels, Grey(4, 2).pixels);
}

}  // namespace
}  // namespace furrow::character
