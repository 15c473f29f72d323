// SPDX-License-Identifier: Apache-2.0
#include "render/mesh/mesh_levels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/render/character_parts.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

glm::vec3 CornerOf(const character::Mesh& mesh, const MeshLevel& level, std::size_t i) {
  return mesh.vertices[level.indices[i]].position;
}

TEST(MeshLevels, ReduceTheTrianglesAndStateTheError) {
  const character::Mesh mesh = test::MakeHead().meshes[0];
  const std::vector<MeshLevel> levels = MakeMeshLevels(mesh, Borders::kKeep);
  ASSERT_GE(levels.size(), 3u);
  EXPECT_EQ(levels[0].indices, mesh.indices);
  EXPECT_EQ(levels[0].error, 0.0f);
  for (std::size_t i = 1; i < levels.size(); ++i) {
    EXPECT_LT(levels[i].indices.size(), levels[i - 1].indices.size() * 4 / 5);
    EXPECT_EQ(levels[i].indices.size() % 3, 0u);
    EXPECT_GE(levels[i].error, levels[i - 1].error);
    EXPECT_LT(levels[i].error, 0.02f);
  }
  EXPECT_GT(levels[1].error, 0.0f);
}

// Every corner of every triangle still faces outwards from the egg, and its centre is near the
// shell.
TEST(MeshLevels, StayNearTheSurfaceAndFlipNoTriangle) {
  const character::Mesh mesh = test::MakeHead().meshes[0];
  const glm::vec3 centre(0.0f, 1.6f, 0.0f);
  for (const MeshLevel& level : MakeMeshLevels(mesh, Borders::kKeep)) {
    double squares = 0.0;
    for (std::size_t i = 0; i < level.indices.size(); i += 3) {
      const glm::vec3 a = CornerOf(mesh, level, i);
      const glm::vec3 b = CornerOf(mesh, level, i + 1);
      const glm::vec3 c = CornerOf(mesh, level, i + 2);
      const glm::vec3 cross = glm::cross(b - a, c - a);
      const glm::vec3 middle = (a + b + c) / 3.0f;
      EXPECT_GE(glm::dot(cross, middle - centre), -1e-9f);  // triangles at a pole have no area
      // Distance of the flat triangle below its corners, as seen from the egg's centre.
      const float shell =
          (glm::length(a - centre) + glm::length(b - centre) + glm::length(c - centre)) / 3.0f;
      squares += std::pow(shell - glm::length(middle - centre), 2.0);
    }
    const double off = std::sqrt(squares / (static_cast<double>(level.indices.size()) / 3.0));
    EXPECT_LT(off, 0.001 + 3.0 * level.error);
  }
}

// Both columns of vertices along the seam are kept.
TEST(MeshLevels, KeepSeams) {
  const character::Mesh mesh = test::MakeHead().meshes[0];
  const std::vector<MeshLevel> levels = MakeMeshLevels(mesh, Borders::kKeep);
  const std::set<std::uint32_t> left(levels.back().indices.begin(), levels.back().indices.end());
  int on_seam = 0;
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    const float u = mesh.vertices[i].uv.x;
    if (u > 1e-4f && u < 1.0f - 1e-4f) continue;
    EXPECT_TRUE(left.contains(i)) << i;
    ++on_seam;
  }
  EXPECT_GT(on_seam, 10);
}

// Adjacent strips of `segments` quads each, bent to a quarter of a circle, like hair.
constexpr float kRadius = 0.25f;  // metres
character::Mesh Strips(int count, int segments) {
  character::Mesh mesh;
  for (int strip = 0; strip < count; ++strip) {
    for (int row = 0; row <= segments; ++row) {
      const double angle = 0.5 * std::numbers::pi * row / segments;
      for (const float side : {0.0f, 0.05f}) {
        character::Vertex vertex;
        vertex.position = {0.1f * static_cast<float>(strip) + side, kRadius * std::sin(angle),
                           kRadius * std::cos(angle)};
        mesh.vertices.push_back(vertex);
        if (row == segments || side > 0.0f) continue;
        const auto a = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
        mesh.indices.insert(mesh.indices.end(), {a, a + 2, a + 3, a, a + 3, a + 1});
      }
    }
  }
  return mesh;
}

// Every vertex of a strip is on its border. The four corners and the width of a strip are kept.
TEST(MeshLevels, SimplifyBordersAlongThemselves) {
  constexpr int kStrips = 40;
  constexpr int kSegments = 12;
  const character::Mesh mesh = Strips(kStrips, kSegments);
  const std::vector<MeshLevel> levels = MakeMeshLevels(mesh, Borders::kSimplify);
  ASSERT_GE(levels.size(), 4u);
  for (const MeshLevel& level : levels) {
    const std::set<std::uint32_t> left(level.indices.begin(), level.indices.end());
    for (std::uint32_t strip = 0; strip < kStrips; ++strip) {
      const std::uint32_t first = strip * 2 * (kSegments + 1);
      for (const std::uint32_t corner : {0, 1, 2 * kSegments, 2 * kSegments + 1}) {
        EXPECT_TRUE(left.contains(first + corner)) << strip << ' ' << corner;
      }
    }
    // The mean distance between arc and chord of a segment is within the stated error.
    double furthest = 0.0;
    for (std::size_t i = 0; i < level.indices.size(); ++i) {
      const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
      const glm::vec3 middle = 0.5f * (CornerOf(mesh, level, i) + CornerOf(mesh, level, next));
      furthest = std::max(furthest, double{kRadius} - glm::length(glm::vec2(middle.y, middle.z)));
    }
    EXPECT_LT(furthest, 0.001 + 4.0 * level.error);
  }
  EXPECT_LT(levels[2].error, 0.005f);
}

// Two meshes share a border and are simplified separately; there must be no crack.
TEST(MeshLevels, KeepSharedBorders) {
  character::Mesh sheet;
  test::AddGrid(
      20, 20,
      [](float u, float v) {
        character::Vertex vertex;
        vertex.position = {u, v, 0.0f};
        return vertex;
      },
      &sheet);
  const std::vector<MeshLevel> levels = MakeMeshLevels(sheet, Borders::kKeep);
  ASSERT_GE(levels.size(), 3u);
  const std::set<std::uint32_t> left(levels.back().indices.begin(), levels.back().indices.end());
  for (std::uint32_t i = 0; i < sheet.vertices.size(); ++i) {
    const glm::vec3& place = sheet.vertices[i].position;
    const bool is_border = std::min(place.x, place.y) == 0.0f || std::max(place.x, place.y) == 1.0f;
    EXPECT_TRUE(!is_border || left.contains(i)) << i;
  }
}

// A flat sheet of 0.2 m with a shape that raises a bump of 20 mm.
character::Mesh SheetWithBump() {
  character::Mesh sheet;
  test::AddGrid(
      32, 32,
      [](float u, float v) {
        character::Vertex vertex;
        vertex.position = {0.2f * u, 0.2f * v, 0.0f};
        return vertex;
      },
      &sheet);
  character::MorphTarget bump;
  for (std::uint32_t i = 0; i < sheet.vertices.size(); ++i) {
    const glm::vec3 apart = sheet.vertices[i].position - glm::vec3(0.1f, 0.1f, 0.0f);
    const float near = std::max(0.0f, 1.0f - glm::dot(apart, apart) / 0.0009f);  // within 30 mm
    if (near > 0.0f) bump.deltas.push_back({i, {0.0f, 0.0f, 0.02f * near * near}});
  }
  sheet.morph_targets = {bump};
  return sheet;
}

// In the rest pose, the sheet is flat and every vertex inside is superfluous.
TEST(MeshLevels, CountWhatMorphTargetsMove) {
  const character::Mesh sheet = SheetWithBump();
  std::vector<float> height(sheet.vertices.size(), 0.0f);
  for (const auto& delta : sheet.morph_targets[0].deltas) height[delta.vertex] = delta.position.z;
  const std::vector<MeshLevel> levels = MakeMeshLevels(sheet, Borders::kKeep);
  ASSERT_GE(levels.size(), 3u);
  for (const MeshLevel& level : levels) {
    // The height of the moved level above each vertex of the mesh.
    float worst = 0.0f;
    for (std::uint32_t v = 0; v < sheet.vertices.size(); ++v) {
      const glm::vec2 at(sheet.vertices[v].position);
      float nearest = std::numeric_limits<float>::max();
      for (std::size_t i = 0; i < level.indices.size(); i += 3) {
        const glm::vec2 a(CornerOf(sheet, level, i));
        const glm::vec2 b = glm::vec2(CornerOf(sheet, level, i + 1)) - a;
        const glm::vec2 c = glm::vec2(CornerOf(sheet, level, i + 2)) - a;
        const float area = b.x * c.y - b.y * c.x;
        const float s = ((at - a).x * c.y - (at - a).y * c.x) / area;
        const float t = (b.x * (at - a).y - b.y * (at - a).x) / area;
        if (!(s >= -1e-4f && t >= -1e-4f && s + t <= 1.0001f)) continue;
        const float drawn = (1.0f - s - t) * height[level.indices[i]] +
                            s * height[level.indices[i + 1]] + t * height[level.indices[i + 2]];
        nearest = std::min(nearest, std::abs(drawn - height[v]));
      }
      worst = std::max(worst, nearest);
    }
    EXPECT_LE(worst, level.error + 1e-6f) << level.indices.size() / 3 << " triangles";
  }
  EXPECT_LT(levels[2].error, 0.001f) << "the flat part goes first";
}

// Without targets, nothing changes; a target that moves all vertices alike costs nothing.
TEST(MeshLevels, RigidMotionIsFree) {
  character::Mesh sheet = SheetWithBump();
  sheet.morph_targets.clear();
  const std::vector<MeshLevel> still = MakeMeshLevels(sheet, Borders::kKeep);
  character::MorphTarget shift;
  for (std::uint32_t i = 0; i < sheet.vertices.size(); ++i) {
    shift.deltas.push_back({i, {0.03f, 0.0f, 0.01f}});
  }
  sheet.morph_targets = {shift};
  const std::vector<MeshLevel> moved = MakeMeshLevels(sheet, Borders::kKeep);
  ASSERT_EQ(moved.size(), still.size());
  EXPECT_LT(moved.back().error, 1e-5f);
}

// Inputs of 200,000 elements that must not take quadratic time: many vertices at one position, and
// many triangles around one vertex.
TEST(MeshLevels, StayFastWithManyElementsInOnePlace) {
  constexpr std::uint32_t kMany = 200'000;
  character::Mesh heap;
  heap.vertices.resize(kMany);
  for (std::uint32_t i = 0; i + 2 < kMany; i += 3) {
    heap.indices.insert(heap.indices.end(), {i, i + 1, i + 2});
  }
  EXPECT_EQ(MakeMeshLevels(heap, Borders::kSimplify).size(), 1u);
  character::Mesh fan;
  fan.vertices.resize(kMany + 1);
  for (std::uint32_t i = 0; i < kMany; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kMany;
    fan.vertices[i + 1].position = {std::sin(angle), std::cos(angle), 0.0};
    fan.indices.insert(fan.indices.end(), {0, i + 1, 1 + (i + 1) % kMany});
  }
  for (const Borders borders : {Borders::kKeep, Borders::kSimplify}) {
    EXPECT_EQ(MakeMeshLevels(fan, borders).size(), 1u);
  }
}

TEST(MeshLevels, EmptyAndSmallMeshesHaveOneLevel) {
  EXPECT_EQ(MakeMeshLevels({}, Borders::kKeep).size(), 1u);
  const character::Mesh plane = test::MakePlane(4, [](float, float) { return 0.0f; }, {}).meshes[0];
  EXPECT_EQ(MakeMeshLevels(plane, Borders::kKeep).size(), 1u);
}

}  // namespace
}  // namespace furrow::render
