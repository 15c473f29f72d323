// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/surface/uv_check.h"

#include <array>
#include <limits>

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

// A square of `cells` x `cells` quads, 1 m wide. Its UVs fill [u0, u1] x [v0, v1].
character::Mesh UvSquare(int cells, float u0, float v0, float u1, float v1) {
  character::Mesh mesh;
  for (int y = 0; y <= cells; ++y) {
    for (int x = 0; x <= cells; ++x) {
      const glm::vec2 t = glm::vec2(x, y) / static_cast<float>(cells);
      character::Vertex vertex;
      vertex.position = {t.x, 1.0f - t.y, 0.0f};
      vertex.uv = {u0 + t.x * (u1 - u0), v0 + t.y * (v1 - v0)};
      mesh.vertices.push_back(vertex);
    }
  }
  const auto at = [cells](int x, int y) { return static_cast<std::uint32_t>(y * (cells + 1) + x); };
  for (int y = 0; y < cells; ++y) {
    for (int x = 0; x < cells; ++x) {
      for (const std::uint32_t i :
           {at(x, y), at(x, y + 1), at(x + 1, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)}) {
        mesh.indices.push_back(i);
      }
    }
  }
  return mesh;
}

UvReport Check(std::vector<character::Mesh> meshes) {
  character::Character character;
  character.meshes = std::move(meshes);
  std::vector<int> all;
  for (std::size_t i = 0; i < character.meshes.size(); ++i) all.push_back(static_cast<int>(i));
  return CheckUvs(character, all, 256);
}

TEST(UvCheck, NeighboursShareNoSamples) {
  // With 7 cells, corners lie between samples and edges pass through samples.
  const UvReport report = Check({UvSquare(7, 0.0f, 0.0f, 1.0f, 1.0f)});
  EXPECT_EQ(report.triangles, 98);
  EXPECT_EQ(report.islands, 1);
  EXPECT_EQ(report.overlapping, 0.0f);
  EXPECT_EQ(report.covered, 1.0f);
  EXPECT_FALSE(report.example);
  EXPECT_EQ(report.outside_triangles + report.unmapped_triangles + report.degenerate_triangles, 0);
}

TEST(UvCheck, IslandsSideBySideDoNotOverlap) {
  const UvReport report =
      Check({UvSquare(3, 0.0f, 0.0f, 0.4f, 0.4f), UvSquare(3, 0.4f, 0.0f, 0.8f, 0.4f)});
  EXPECT_EQ(report.islands, 2);
  EXPECT_EQ(report.overlapping, 0.0f);
  EXPECT_NEAR(report.covered, 0.32f, 0.01f);
}

TEST(UvCheck, MeasuresAndLocatesOverlaps) {
  const UvReport report =
      Check({UvSquare(2, 0.0f, 0.0f, 0.5f, 0.5f), UvSquare(2, 0.25f, 0.0f, 0.75f, 0.5f)});
  EXPECT_NEAR(report.covered, 0.375f, 0.01f);
  EXPECT_NEAR(report.overlapping, 1.0f / 3.0f, 0.01f);
  ASSERT_TRUE(report.example);
  EXPECT_EQ(report.example->meshes[0], 0);
  EXPECT_EQ(report.example->meshes[1], 1);
  EXPECT_GT(report.example->uv.x, 0.25f);
  EXPECT_LT(report.example->uv.x, 0.5f);
}

// Both halves of a face share one half of the picture, with opposite winding.
TEST(UvCheck, DetectsMirroredHalves) {
  character::Mesh both = UvSquare(4, 0.0f, 0.0f, 1.0f, 1.0f);
  for (character::Vertex& vertex : both.vertices)
    vertex.uv.x = std::min(vertex.uv.x, 1.0f - vertex.uv.x);
  EXPECT_NEAR(Check({both}).overlapping, 1.0f, 0.01f);
}

TEST(UvCheck, DistinguishesMissingUvsFromUnmappedPieces) {
  character::Mesh none = UvSquare(2, 0, 0, 1, 1);
  for (character::Vertex& vertex : none.vertices) vertex.uv = {};
  const UvReport without = Check({none});
  EXPECT_TRUE(without.no_uvs());
  EXPECT_EQ(without.unmapped_triangles, 8);
  const UvReport some = Check({none, UvSquare(2, 0, 0, 1, 1)});
  EXPECT_FALSE(some.no_uvs());
  EXPECT_EQ(some.unmapped_triangles, 8);
  EXPECT_FALSE(Check({}).no_uvs());
}

TEST(UvCheck, CountsTrianglesWithoutArea) {
  character::Mesh mesh = UvSquare(2, 0, 0, 1, 1);
  mesh.indices.insert(mesh.indices.end(), {0, 1, 2});  // collinear vertices
  mesh.indices.insert(mesh.indices.end(), {4, 4, 4});
  const UvReport report = Check({mesh});
  EXPECT_EQ(report.degenerate_triangles, 2);
  EXPECT_EQ(report.unmapped_triangles, 0);
}

TEST(UvCheck, WrapsLikeASampler) {
  const UvReport apart = Check({UvSquare(2, 0.75f, 0.0f, 1.25f, 0.5f)});
  EXPECT_EQ(apart.overlapping, 0.0f);
  EXPECT_EQ(apart.outside_triangles, 4);  // the right half
  const UvReport twice =
      Check({UvSquare(2, 0.0f, 0.0f, 0.25f, 0.5f), UvSquare(2, 1.0f, 0.0f, 1.25f, 0.5f)});
  EXPECT_NEAR(twice.overlapping, 1.0f, 1e-6f);
}

TEST(UvCheck, HostileUvsAreNotSlow) {
  character::Mesh mesh = UvSquare(40, -900.0f, -900.0f, 900.0f, 900.0f);
  mesh.vertices[0].uv.x = std::numeric_limits<float>::quiet_NaN();
  mesh.vertices[3].uv.y = std::numeric_limits<float>::infinity();
  const UvReport report = Check({mesh});
  EXPECT_GT(report.overlapping, kTolerableUvOverlap);
  EXPECT_GT(report.unmapped_triangles, 0);
}

}  // namespace
}  // namespace furrow::authoring
