// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/textures/wrinkle_maps.h"

#include <algorithm>
#include <vector>

#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include "authoring/paint/strokes.h"

namespace furrow::authoring {
namespace {

// A normal map whose slopes are all `slope`, and a map of two texels, one of them folded.
character::Picture Normals(const glm::vec2& slope) {
  std::vector<SurfaceTexel> texels(2);
  texels[1].x = 1;
  return EncodeNormals(texels, std::vector<glm::vec2>(2, slope), 2, 1, 16);
}

glm::vec2 SlopeAt(const character::Picture& normals, std::size_t texel) {
  const auto value = [&](std::size_t channel) {
    return static_cast<float>(normals.pixels16[3 * texel + channel]) / 65535.0f * 2.0f - 1.0f;
  };
  return glm::vec2(value(0), value(1)) / value(2);
}

// The bake multiplies all depths, so creases of lids come out as deep as on a young face.
TEST(AgedStrokes, CreasesOfLidsDoNotDeepen) {
  const BakeStroke lid{.name = "lid_crease_l", .depth_mm = 1.0f};
  const BakeStroke brow{.name = "brow_raise_l", .depth_mm = 0.5f};
  const BakeStroke strokes[] = {lid, brow};
  for (const float depth : {0.8f, 1.0f, 1.7f, 2.5f}) {
    const std::vector<BakeStroke> aged = AgedStrokes(strokes, depth);
    ASSERT_EQ(aged.size(), 2u);
    EXPECT_FLOAT_EQ(WrinkleMapOptions(64, depth).skin.depth * aged[0].depth_mm,
                    std::min(depth, 1.0f));
    EXPECT_FLOAT_EQ(aged[1].depth_mm, 0.5f);
  }
}

// Nor do the ridges of narrow strokes, which would be sharper than skin can fold.
TEST(AgedStrokes, NarrowRidgesDoNotSharpen) {
  const BakeStroke narrow{.name = "bunny_1_l", .width_mm = 3.0f, .depth_mm = 1.0f, .ridge = 0.6f};
  const BakeStroke wide{.name = "nasolabial_l", .width_mm = 6.0f, .depth_mm = 1.0f, .ridge = 0.6f};
  const BakeStroke strokes[] = {narrow, wide};
  const std::vector<BakeStroke> aged = AgedStrokes(strokes, 1.6f);
  EXPECT_FLOAT_EQ(1.6f * aged[0].depth_mm * aged[0].ridge, 0.6f);
  EXPECT_EQ(aged[0].depth_mm, 1.0f);
  EXPECT_EQ(aged[1].ridge, 0.6f);
  EXPECT_EQ(AgedStrokes(strokes, 0.8f)[0].ridge, 0.6f);
  // The creases of lids keep their depth, and so do their ridges.
  const BakeStroke lid{.name = "lid_1_l", .width_mm = 2.6f, .depth_mm = 0.3f, .ridge = 0.5f};
  const BakeStroke old = AgedStrokes(std::span(&lid, 1), 1.6f)[0];
  EXPECT_FLOAT_EQ(1.6f * old.depth_mm * old.ridge, 0.3f * 0.5f);
}

TEST(RestingFolds, AddAShareOfTheSlopes) {
  BakedMap map;
  map.width = 2;
  map.height = 1;
  map.derivative = {0.0f, 0.0f, 0.8f, -0.4f};
  character::Picture normals = Normals({0.1f, 0.05f});
  AddRestingFolds(map, 0.25f, &normals);
  EXPECT_NEAR(SlopeAt(normals, 0).x, 0.1f, 1e-3f);
  EXPECT_NEAR(SlopeAt(normals, 1).x, 0.1f + 0.2f, 1e-3f);
  EXPECT_NEAR(SlopeAt(normals, 1).y, 0.05f - 0.1f, 1e-3f);
}

TEST(RestingFolds, LeaveOtherSizesAlone) {
  BakedMap map;
  map.width = map.height = 4;
  map.derivative.assign(32, 0.5f);
  character::Picture normals = Normals({0.1f, 0.0f});
  const std::vector<std::uint16_t> before = normals.pixels16;
  AddRestingFolds(map, 0.5f, &normals);
  EXPECT_EQ(normals.pixels16, before);
}

}  // namespace
}  // namespace furrow::authoring
