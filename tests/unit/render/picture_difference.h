// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include <gtest/gtest.h>

#include "render/request/image.h"

// How far two pictures of the same size differ. Channels have 0 to 255.
namespace furrow::render::test {

// The largest difference of a channel in one pixel.
inline int DifferenceAt(const Image& a, const Image& b, std::size_t pixel) {
  int most = 0;
  for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
    most = std::max(most, std::abs(int{a.rgb[i]} - int{b.rgb[i]}));
  }
  return most;
}

// The largest difference of a channel in any pixel.
inline int LargestDifference(const Image& a, const Image& b) {
  EXPECT_EQ(a.rgb.size(), b.rgb.size());
  int most = 0;
  for (std::size_t pixel = 0; pixel < std::min(a.rgb.size(), b.rgb.size()) / 3; ++pixel) {
    most = std::max(most, DifferenceAt(a, b, pixel));
  }
  return most;
}

// The number of pixels in which a channel differs by more than `limit`.
inline int NumDifferent(const Image& a, const Image& b, int limit) {
  EXPECT_EQ(a.rgb.size(), b.rgb.size());
  int count = 0;
  for (std::size_t pixel = 0; pixel < std::min(a.rgb.size(), b.rgb.size()) / 3; ++pixel) {
    count += DifferenceAt(a, b, pixel) > limit ? 1 : 0;
  }
  return count;
}

}  // namespace furrow::render::test
