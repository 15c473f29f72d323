// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/face/skin_paint.h"

#include <vector>

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

// Two texels at the same place, 20 mm from the middle of the mouth: the inside of a cheek, and the
// cheek of a flat face. Only the inside is dark.
TEST(PaintMakeHumanSkin, OnlyTheInsideOfTheMouthIsDark) {
  FaceLandmarks face;
  face.upper_lip = {0.0f, 1.60f, 0.136f};
  face.lower_lip = {0.0f, 1.58f, 0.136f};
  face.lower_lip_bottom = {0.0f, 1.57f, 0.13f};
  face.crown.y = 1.8f;
  for (FaceLandmarks::Side& side : face.sides) side.brow_middle.y = 1.7f;
  std::vector<SurfaceTexel> texels(2);
  for (int i = 0; i < 2; ++i) {
    SurfaceTexel& texel = texels[static_cast<std::size_t>(i)];
    texel.x = 30 * i;
    texel.position = {0.02f, 1.59f, 0.10f};
    texel.normal = {i == 0 ? -1.0f : 1.0f, 0.0f, 0.0f};
  }
  const character::Picture picture = PaintMakeHumanSkin(texels, face, {}, 64);
  const int inside = picture.pixels[0], cheek = picture.pixels[90];
  EXPECT_LT(inside, 90);
  EXPECT_GT(cheek, 150);
}

}  // namespace
}  // namespace furrow::authoring
