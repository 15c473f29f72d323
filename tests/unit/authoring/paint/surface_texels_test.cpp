// SPDX-License-Identifier: Apache-2.0
#include "authoring/paint/surface_texels.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "authoring/paint/dilate.h"
#include "character/mesh/tangents.h"

namespace furrow::authoring {
namespace {

// A square of 2 x 2 metres in the plane z = 0. Its UVs fill [low, high].
character::Mesh TexelSquare(glm::vec2 low, glm::vec2 high) {
  character::Mesh mesh;
  for (const glm::vec2 corner : {glm::vec2(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
    character::Vertex vertex;
    vertex.position = glm::vec3(2.0f * corner, 0.0f);
    vertex.uv = {low.x + (high.x - low.x) * corner.x, high.y - (high.y - low.y) * corner.y};
    mesh.vertices.push_back(vertex);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  character::paint::ComputeTangents(mesh.vertices, mesh.indices);
  return mesh;
}

TEST(UvRaster, CoversEachTexelOnceWithItsPosition) {
  const std::vector<SurfaceTexel> texels = RasterizeSurface(TexelSquare({0, 0}, {1, 1}), 8, 4);
  ASSERT_EQ(texels.size(), 32u);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const SurfaceTexel& t = texels[i];
    EXPECT_EQ(t.x, static_cast<int>(i) % 8);
    EXPECT_EQ(t.y, static_cast<int>(i) / 8);
    EXPECT_NEAR(t.position.x, 2.0f * (static_cast<float>(t.x) + 0.5f) / 8.0f, 1e-5f);
    EXPECT_NEAR(t.position.y, 2.0f - 2.0f * (static_cast<float>(t.y) + 0.5f) / 4.0f, 1e-5f);
    EXPECT_NEAR(glm::distance(t.tangent, glm::vec3(1, 0, 0)), 0.0f, 1e-5f);
    EXPECT_NEAR(glm::distance(t.bitangent, glm::vec3(0, 1, 0)), 0.0f,
                1e-5f);  // upwards in the picture
  }
}

TEST(UvRaster, WrapsAroundAndTheFirstTriangleWins) {
  EXPECT_EQ(RasterizeSurface(TexelSquare({-0.5f, 0}, {0.5f, 1}), 8, 8).size(), 64u);
  EXPECT_EQ(RasterizeSurface(TexelSquare({0, 0}, {3, 1}), 8, 8).size(), 64u);  // wraps three times
  EXPECT_TRUE(RasterizeSurface(TexelSquare({0.5f, 0}, {0.5f, 1}), 8, 8).empty());  // no area
  EXPECT_TRUE(
      RasterizeSurface(TexelSquare({0, 0}, {1e30f, 1}), 8, 8).empty());  // too large to rasterise
}

TEST(UvRaster, DilationGrowsRingByRing) {
  const std::vector<SurfaceTexel> texels =
      RasterizeSurface(TexelSquare({0.5f, 0.5f}, {0.625f, 0.625f}), 8, 8);
  ASSERT_EQ(texels.size(), 1u);
  for (const int passes : {0, 1, 2}) {
    character::Picture picture;
    picture.width = picture.height = 8;
    picture.channels = 1;
    picture.pixels16.assign(64, 0);
    picture.pixels16[static_cast<std::size_t>(texels[0].y * 8 + texels[0].x)] = 40000;
    Dilate(&picture, texels, passes);
    const auto painted = std::count(picture.pixels16.begin(), picture.pixels16.end(), 40000);
    EXPECT_EQ(painted, (2 * passes + 1) * (2 * passes + 1));
  }
}

}  // namespace
}  // namespace furrow::authoring
