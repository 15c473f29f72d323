// SPDX-License-Identifier: Apache-2.0
#include "authoring/paint/hair_strands.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "authoring/paint/canvas.h"

namespace furrow::authoring {
namespace {

constexpr int kPictureSize = 512;

struct Painted {
  character::Picture colour = BlankPicture("colour", kPictureSize, kPictureSize, 4);
  character::Picture normals = BlankPicture("normals", kPictureSize, kPictureSize, 3);
};

Painted Paint(const StrandLook& look) {
  Painted painted;
  PaintStrands(look, &painted.colour, &painted.normals);
  return painted;
}

// Fraction of opaque texels in a tile between `from` and `to` (0 is the root, 1 the tip).
float Coverage(Painted* painted, int tile, float from, float to) {
  int covered = 0, all = 0;
  const auto low = StrandUv(tile, -1.0f, from), high = StrandUv(tile, 1.0f, to);
  for (int y = static_cast<int>(low.y * kPictureSize); y < static_cast<int>(high.y * kPictureSize);
       ++y) {
    for (int x = static_cast<int>(low.x * kPictureSize);
         x < static_cast<int>(high.x * kPictureSize); ++x) {
      covered += TexelAt(&painted->colour, x, y)[3] >= kStrandCutoff * 255.0f;
      ++all;
    }
  }
  return static_cast<float>(covered) / static_cast<float>(all);
}

TEST(HairStrands, AreDensestInTheMiddle) {
  Painted painted = Paint({});
  for (int tile = 0; tile < kFullTiles + kSparseTiles; ++tile) {
    SCOPED_TRACE(tile);
    const float middle = Coverage(&painted, tile, 0.4f, 0.6f);
    EXPECT_LT(Coverage(&painted, tile, 0.92f, 1.0f), 0.5f * middle);
    EXPECT_LT(Coverage(&painted, tile, 0.0f, 0.05f), middle);
    if (tile < kFullTiles) {
      EXPECT_GT(middle, 0.6f);
    } else {
      EXPECT_LT(middle, 0.6f);
    }
    EXPECT_GT(middle, 0.05f);
  }
}

TEST(HairStrands, DoNotChangeOtherRows) {
  Painted painted = Paint({});
  for (int y = static_cast<int>(std::ceil(kStrandBottom * kPictureSize)); y < kPictureSize; ++y) {
    for (int x = 0; x < kPictureSize; ++x) {
      ASSERT_EQ(TexelAt(&painted.colour, x, y)[3], 0);
      ASSERT_EQ(TexelAt(&painted.normals, x, y)[2], 0);
    }
  }
}

TEST(HairStrands, NormalsVaryOnlyAcrossStrands) {
  Painted painted = Paint({});
  int left = 255, right = 0;
  for (int y = 0; y < static_cast<int>(kStrandBottom * kPictureSize); ++y) {
    for (int x = 0; x < kPictureSize; ++x) {
      const std::uint8_t* normal = TexelAt(&painted.normals, x, y);
      ASSERT_NEAR(normal[1], 128, 1);
      left = std::min<int>(left, normal[0]);
      right = std::max<int>(right, normal[0]);
    }
  }
  EXPECT_LT(left, 90);
  EXPECT_GT(right, 165);
}

TEST(HairStrands, GreyIsBrighterAndLessSaturated) {
  Painted brown = Paint({}), grey = Paint({.grey_share = 1.0f});
  const auto uv = StrandUv(0, 0.0f, 0.5f);
  const int x = static_cast<int>(uv.x * kPictureSize), y = static_cast<int>(uv.y * kPictureSize);
  const std::uint8_t* a = TexelAt(&brown.colour, x, y);
  const std::uint8_t* b = TexelAt(&grey.colour, x, y);
  EXPECT_GT(b[1], 2 * a[1]);
  EXPECT_LT((b[0] - b[2]) / static_cast<float>(b[1]), (a[0] - a[2]) / static_cast<float>(a[1]));
}

}  // namespace
}  // namespace furrow::authoring
