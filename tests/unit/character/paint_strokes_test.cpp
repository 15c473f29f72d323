// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "character/paint/strokes.h"
#include "character/paint/tangents.h"

namespace furrow::character::paint {
namespace {

// A square of 10 cm in the plane z = 0, facing +Z, unwrapped whole: u along x, v down.
Mesh Square() {
  Mesh mesh;
  for (const glm::vec2 corner :
       {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
    Vertex vertex;
    vertex.position = glm::vec3(0.1f * corner, 0.0f);
    vertex.uv = {corner.x, 1.0f - corner.y};
    mesh.vertices.push_back(vertex);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  ComputeTangents(mesh.vertices, mesh.indices);
  return mesh;
}

FoldStroke Across() {
  FoldStroke stroke;
  stroke.points = {{0.02f, 0.05f, 0.0f}, {0.08f, 0.05f, 0.0f}};
  stroke.width = 0.004f;
  stroke.depth = 0.001f;
  return stroke;
}

TEST(PaintTangents, FollowTheTexture) {
  const Mesh mesh = Square();
  for (const Vertex& vertex : mesh.vertices) {
    EXPECT_NEAR(vertex.tangent.x, 1.0f, 1e-6f);
    EXPECT_EQ(vertex.tangent.w, 1.0f);  // the bitangent points up the picture
  }
}

TEST(PaintTangents, MirroredUvsTurnTheBitangent) {
  Mesh mesh = Square();
  for (Vertex& vertex : mesh.vertices) vertex.uv.x = 1.0f - vertex.uv.x;
  ComputeTangents(mesh.vertices, mesh.indices);
  for (const Vertex& vertex : mesh.vertices) {
    EXPECT_NEAR(vertex.tangent.x, -1.0f, 1e-6f);
    EXPECT_EQ(vertex.tangent.w, -1.0f);
  }
}

TEST(PaintStrokes, ValleyIsAsDeepAsStatedAndTapersToNothing) {
  const FoldStroke stroke = Across();
  const float bottom = StrokeHeight(stroke, {0.05f, 0.05f, 0.0f});
  // The far foot of the ridge reaches the line: ridge * exp(-4) of the depth.
  EXPECT_NEAR(bottom, stroke.depth * (stroke.ridge * std::exp(-4.0f) - 1.0f), 1e-7f);
  EXPECT_GT(StrokeHeight(stroke, {0.05f, 0.05f + stroke.width, 0.0f}), 0.2f * stroke.depth);
  EXPECT_EQ(StrokeHeight(stroke, {0.02f, 0.05f, 0.0f}), 0.0f);
  EXPECT_EQ(StrokeHeight(stroke, {0.08f, 0.05f, 0.0f}), 0.0f);
  EXPECT_EQ(StrokeHeight(stroke, {0.05f, 0.09f, 0.0f}), 0.0f);
}

// Slopes are the negative gradient of the height, which finite differences give independently.
TEST(PaintStrokes, SlopesAreTheGradientOfTheHeight) {
  const Mesh mesh = Square();
  const FoldStroke stroke = Across();
  const std::vector<Texel> texels = RasterizeUv(mesh, 128, 128);
  const std::vector<glm::vec2> slopes = StrokeSlopes(texels, std::vector{stroke});
  ASSERT_EQ(slopes.size(), texels.size());
  constexpr float kStep = 2e-5f;
  int touched = 0;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const glm::vec3 p = texels[i].position;
    // Away from the ends, where the taper adds a slope along the line that is left out.
    if (std::abs(p.x - 0.05f) > 0.008f || std::abs(p.y - 0.05f) > 0.0095f) continue;
    const glm::vec3 up(0, kStep, 0);
    const float dh = (StrokeHeight(stroke, p + up) - StrokeHeight(stroke, p - up)) / (2 * kStep);
    EXPECT_NEAR(slopes[i].y, -dh, 0.01f + 0.02f * std::abs(dh));
    EXPECT_NEAR(slopes[i].x, 0.0f, 1e-4f);
    touched += std::abs(slopes[i].y) > 0.05f;
  }
  EXPECT_GT(touched, 50);
}

TEST(PaintStrokes, SuperposedStrokesAdd) {
  const std::vector<Texel> texels = RasterizeUv(Square(), 64, 64);
  FoldStroke other = Across();
  for (glm::vec3& point : other.points) point.y += 0.003f;
  const auto a = StrokeSlopes(texels, std::vector{Across()});
  const auto b = StrokeSlopes(texels, std::vector{other});
  const auto both = StrokeSlopes(texels, std::vector{Across(), other});
  for (std::size_t i = 0; i < texels.size(); ++i) {
    EXPECT_NEAR(glm::distance(both[i], a[i] + b[i]), 0.0f, 1e-6f);
  }
}

TEST(PaintStrokes, TouchOnlyTheSideTheyFace) {
  const std::vector<Texel> texels = RasterizeUv(Square(), 64, 64);
  FoldStroke behind = Across();
  behind.facing = {0, 0, -1};
  for (const glm::vec2& slope : StrokeSlopes(texels, std::vector{behind})) {
    EXPECT_EQ(slope, glm::vec2(0.0f));
  }
}

TEST(PaintStrokes, NormalMapSaysTheSlope) {
  const std::vector<Texel> texels = RasterizeUv(Square(), 8, 8);
  const std::vector<glm::vec2> slopes(texels.size(), glm::vec2(0.5f, -0.25f));
  const Picture map = EncodeNormals(texels, slopes, 8, 8);
  ASSERT_EQ(map.pixels16.size(), 8u * 8u * 3u);
  const auto decode = [&](int c) { return static_cast<float>(map.pixels16[c]) / 65535.0f * 2 - 1; };
  EXPECT_NEAR(decode(0) / decode(2), 0.5f, 1e-3f);
  EXPECT_NEAR(decode(1) / decode(2), -0.25f, 1e-3f);
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
}  // namespace furrow::character::paint
