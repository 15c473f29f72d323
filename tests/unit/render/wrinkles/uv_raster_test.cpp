// SPDX-License-Identifier: Apache-2.0
#include "render/wrinkles/uv_raster.h"

#include <cmath>
#include <limits>
#include <map>

#include <gtest/gtest.h>

namespace furrow::render {
namespace {

std::map<std::size_t, UvTexel> TexelsOf(const UvTriangle& triangle, glm::ivec2 size, float reach) {
  std::map<std::size_t, UvTexel> texels;
  ForTexels(triangle, size, reach, [&](const UvTexel& texel) { texels[texel.index] = texel; });
  return texels;
}

TEST(UvRaster, SharesLocateATexel) {
  const UvTriangle triangle = {glm::vec2(0.1f, 0.2f), {0.9f, 0.3f}, {0.4f, 0.85f}};
  const glm::ivec2 size(32, 16);
  const auto texels = TexelsOf(triangle, size, 0.0f);
  for (const auto& [index, texel] : texels) {
    const glm::vec2 centre((static_cast<float>(index % 32) + 0.5f) / 32.0f,
                           (static_cast<float>(index / 32) + 0.5f) / 16.0f);
    const glm::vec2 place =
        texel.shares.x * triangle[0] + texel.shares.y * triangle[1] + texel.shares.z * triangle[2];
    EXPECT_NEAR(place.x, centre.x, 1e-5f);
    EXPECT_NEAR(place.y, centre.y, 1e-5f);
    EXPECT_EQ(texel.distance_squared, 0.0f);
  }
  // The triangle covers 0.245 of the texture.
  EXPECT_NEAR(static_cast<double>(texels.size()), 0.245 * 32 * 16, 8.0);
}

TEST(UvRaster, OutsideTheTriangleTheNearestPointCounts) {
  // The lower left half of a square from texel 4 to texel 8.
  const UvTriangle triangle = {glm::vec2(0.25f, 0.25f), {0.5f, 0.25f}, {0.25f, 0.5f}};
  const auto texels = TexelsOf(triangle, {16, 16}, 1.5f);
  const UvTexel& left = texels.at(5 * 16 + 3);  // half a texel from the edge u = 0.25
  EXPECT_NEAR(left.distance_squared, 0.25f, 1e-5f);
  EXPECT_NEAR(left.shares.y, 0.0f, 1e-6f);
  EXPECT_NEAR(left.shares.z, 1.5f / 4.0f, 1e-5f);
  const UvTexel& corner = texels.at(3 * 16 + 3);
  EXPECT_NEAR(corner.distance_squared, 0.5f, 1e-5f);
  EXPECT_NEAR(corner.shares.x, 1.0f, 1e-6f);
  EXPECT_FALSE(texels.contains(5 * 16 + 2 - 1));  // 2.5 texels away
}

TEST(UvRaster, TexturesRepeat) {
  const UvTriangle triangle = {glm::vec2(-0.1f, 0.9f), {0.4f, 0.9f}, {-0.1f, 1.4f}};
  const auto texels = TexelsOf(triangle, {8, 8}, 0.0f);
  EXPECT_TRUE(texels.contains(7 * 8 + 7));  // (-0.06, 0.94)
  EXPECT_TRUE(texels.contains(0));          // (0.06, 1.06)
  for (const auto& [index, texel] : texels) EXPECT_LT(index, 64u);
}

TEST(UvRaster, ADegenerateTriangleHasTexels) {
  const UvTriangle line = {glm::vec2(0.25f, 0.5f), {0.75f, 0.5f}, {0.5f, 0.5f}};
  EXPECT_TRUE(TexelsOf(line, {16, 16}, 0.0f).empty());
  EXPECT_NEAR(TexelsOf(line, {16, 16}, 1.0f).at(8 * 16 + 8).distance_squared, 0.25f, 1e-5f);
}

TEST(UvRaster, ManyOverlappingTrianglesAreNoAtlas) {
  const UvTriangle small = {glm::vec2(0.0f), {0.5f, 0.0f}, {0.0f, 0.5f}};
  EXPECT_TRUE(IsAtlas(std::vector{small, small}));
  EXPECT_FALSE(IsAtlas(std::vector(65, small)));
  for (const float bad : {1.5f, 1e30f, std::numeric_limits<float>::quiet_NaN()}) {
    UvTriangle broken = small;
    broken[1].x = bad;
    EXPECT_FALSE(IsAtlas(std::vector{broken})) << bad;
  }
  UvTriangle far = small;
  for (glm::vec2& corner : far) corner += 1e6f;
  EXPECT_FALSE(IsAtlas(std::vector{far}));
}

}  // namespace
}  // namespace furrow::render
