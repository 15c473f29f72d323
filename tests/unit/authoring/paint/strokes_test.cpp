// SPDX-License-Identifier: Apache-2.0
#include "authoring/paint/strokes.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "character/mesh/tangents.h"

namespace furrow::authoring {
namespace {

// A square of 10 cm in the plane z = 0, facing +Z. Its UVs fill the picture: u along x, v down.
character::Mesh Square() {
  character::Mesh mesh;
  for (const glm::vec2 corner :
       {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
    character::Vertex vertex;
    vertex.position = glm::vec3(0.1f * corner, 0.0f);
    vertex.uv = {corner.x, 1.0f - corner.y};
    mesh.vertices.push_back(vertex);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  character::paint::ComputeTangents(mesh.vertices, mesh.indices);
  return mesh;
}

TEST(PaintTangents, FollowTheTexture) {
  const character::Mesh mesh = Square();
  for (const character::Vertex& vertex : mesh.vertices) {
    EXPECT_NEAR(vertex.tangent.x, 1.0f, 1e-6f);
    EXPECT_EQ(vertex.tangent.w, 1.0f);  // the bitangent points up in the picture
  }
}

TEST(PaintTangents, MirroredUvsFlipTheBitangent) {
  character::Mesh mesh = Square();
  for (character::Vertex& vertex : mesh.vertices) vertex.uv.x = 1.0f - vertex.uv.x;
  character::paint::ComputeTangents(mesh.vertices, mesh.indices);
  for (const character::Vertex& vertex : mesh.vertices) {
    EXPECT_NEAR(vertex.tangent.x, -1.0f, 1e-6f);
    EXPECT_EQ(vertex.tangent.w, -1.0f);
  }
}

TEST(PaintStrokes, FoldIsAValleyBetweenTwoRidges) {
  // The ridge still adds ridge * exp(-4) of the depth at the line.
  EXPECT_NEAR(FoldShapeAt(0.0f, 0.35f).height, 0.35f * std::exp(-4.0f) - 1.0f, 1e-6f);
  EXPECT_GT(FoldShapeAt(1.0f, 0.35f).height, 0.2f);
  EXPECT_LT(FoldShapeAt(1.0f, 0.0f).height, 0.0f);
  EXPECT_NEAR(FoldShapeAt(kStrokeReach, 0.35f).height, 0.0f, 1e-3f);
  for (float x = 0.05f; x < kStrokeReach; x += 0.1f) {
    const float numeric =
        (FoldShapeAt(x + 1e-3f, 0.35f).height - FoldShapeAt(x - 1e-3f, 0.35f).height) / 2e-3f;
    EXPECT_NEAR(FoldShapeAt(x, 0.35f).slope, numeric, 2e-3f) << x;
  }
}

TEST(PaintStrokes, TaperToNothingAtBothEnds) {
  EXPECT_EQ(StrokeTaper(0.0f, 0.6f), 0.0f);
  EXPECT_EQ(StrokeTaper(1.0f, 0.6f), 0.0f);
  EXPECT_EQ(StrokeTaper(0.5f, 0.6f), 1.0f);
  EXPECT_EQ(StrokeTaper(0.3f, 0.6f), 1.0f);  // each end fades over 0.3 of the length
  EXPECT_NEAR(StrokeTaper(0.15f, 0.6f), 0.5f, 1e-6f);
  EXPECT_NEAR(StrokeTaper(0.15f, 0.6f), StrokeTaper(0.85f, 0.6f), 1e-6f);
}

TEST(PaintStrokes, LineFindsItsNearestPoint) {
  const StrokeLine line({{0, 0, 0}, {1, 0, 0}, {1, 3, 0}});
  EXPECT_EQ(line.length(), 4.0f);
  const StrokeLine::Nearest side = line.FindNearest({3, 1, 0});
  EXPECT_EQ(side.distance, 2.0f);
  EXPECT_EQ(side.place, 0.5f);
  EXPECT_EQ(side.away, glm::vec3(1, 0, 0));
  EXPECT_EQ(glm::normalize(side.along), glm::vec3(0, 1, 0));
  const StrokeLine::Nearest end = line.FindNearest({-3, -4, 0});
  EXPECT_EQ(end.distance, 5.0f);
  EXPECT_EQ(end.place, 0.0f);
  EXPECT_EQ(line.FindNearest({0.5f, 0, 0}).away, glm::vec3(0.0f));
}

TEST(PaintStrokes, NormalMapContainsTheSlope) {
  const std::vector<SurfaceTexel> texels = RasterizeSurface(Square(), 8, 8);
  const std::vector<glm::vec2> slopes(texels.size(), glm::vec2(0.5f, -0.25f));
  const character::Picture map = EncodeNormals(texels, slopes, 8, 8, 11);
  ASSERT_EQ(map.pixels16.size(), 8u * 8u * 3u);
  const auto decode = [&](int c) { return static_cast<float>(map.pixels16[c]) / 65535.0f * 2 - 1; };
  // Half a step of x and y, and half a step of z, which is four times as large.
  const float step = 2.0f / 2048.0f;
  EXPECT_NEAR(decode(0) / decode(2), 0.5f, (0.5f * step + 2.0f * step * 0.5f) / 0.85f);
  EXPECT_NEAR(decode(1) / decode(2), -0.25f, (0.5f * step + 2.0f * step * 0.25f) / 0.85f);
  for (std::size_t i = 0; i < map.pixels16.size(); ++i) {
    const std::uint16_t value = map.pixels16[i];
    EXPECT_TRUE(value % (i % 3 == 2 ? 128 : 32) == 0 || value == 65535) << i;
  }
  const character::Picture flat = EncodeNormals(texels, {}, 8, 8, 8);
  EXPECT_EQ(flat.pixels16[0], 32768);  // zero slope is exact
  EXPECT_EQ(flat.pixels16[2], 65535);
}

TEST(PaintStrokes, SmoothKeepsItsControlPoints) {
  const std::vector<glm::vec3> points = {{0, 0, 0}, {1, 1, 0}, {2, 0, 0}};
  const std::vector<glm::vec3> line = Smooth(points, 4);
  ASSERT_EQ(line.size(), 9u);
  EXPECT_EQ(line.front(), points[0]);
  EXPECT_EQ(line[4], points[1]);
  EXPECT_EQ(line.back(), points[2]);
}

}  // namespace
}  // namespace furrow::authoring
