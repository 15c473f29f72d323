// SPDX-License-Identifier: Apache-2.0
#include "character/mesh/morph_normals.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "character/mesh/tangents.h"

namespace furrow::character {
namespace {

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();
constexpr int kSide = 5;

// A flat sheet of 5 x 5 vertices over [0, 1], facing +Z.
Mesh Sheet() {
  Mesh mesh;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      mesh.vertices.push_back({.position = glm::vec3(x, y, 0) / float(kSide - 1)});
    }
  }
  for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      const std::uint32_t a = y * kSide + x;
      for (const std::uint32_t k : {a, a + 1, a + kSide + 1, a, a + kSide + 1, a + kSide}) {
        mesh.indices.push_back(k);
      }
    }
  }
  return mesh;
}

glm::vec3 MorphedNormal(const Mesh& mesh, std::uint32_t vertex) {
  glm::vec3 normal = mesh.vertices[vertex].normal;
  for (const MorphDelta& delta : mesh.morph_targets[0].deltas) {
    if (delta.vertex == vertex) normal += delta.normal;
  }
  return glm::normalize(normal);
}

const MorphDelta* DeltaOf(const Mesh& mesh, std::uint32_t vertex) {
  for (const MorphDelta& delta : mesh.morph_targets[0].deltas) {
    if (delta.vertex == vertex) return &delta;
  }
  return nullptr;
}

// A fold: the right half rises with a slope of 1.
TEST(MorphNormals, FollowAFold) {
  Mesh mesh = Sheet();
  MorphTarget fold;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const float rise = mesh.vertices[v].position.x - 0.5f;
    if (rise > 0.0f) fold.deltas.push_back({v, glm::vec3(0, 0, rise), {}, {}});
  }
  mesh.morph_targets.push_back(fold);
  ASSERT_TRUE(ComputeMorphNormals({true}, kNoLimit, &mesh).ok());
  const glm::vec3 slope = glm::normalize(glm::vec3(-1, 0, 1));
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const float x = mesh.vertices[v].position.x;
    if (x < 0.5f) {
      EXPECT_EQ(DeltaOf(mesh, v), nullptr) << v;
    } else if (x > 0.5f) {
      EXPECT_LT(glm::distance(MorphedNormal(mesh, v), slope), 1e-5f) << v;
    }
  }
  // Vertices on the fold do not move, but their normals turn: the mean of both slopes.
  const MorphDelta* on_fold = DeltaOf(mesh, 2 * kSide + 2);
  ASSERT_NE(on_fold, nullptr);
  EXPECT_EQ(on_fold->position, glm::vec3(0.0f));
  const float angle =
      std::atan2(-MorphedNormal(mesh, 2 * kSide + 2).x, MorphedNormal(mesh, 2 * kSide + 2).z);
  EXPECT_GT(angle, 0.3f);
  EXPECT_LT(angle, 0.6f);
}

// An offset along the normal and a rotation of the base normal: stored normals are kept, and the
// change is added.
TEST(MorphNormals, LeaveTheMeshesOwnNormals) {
  Mesh mesh = Sheet();
  const glm::vec3 bent = glm::normalize(glm::vec3(0.3f, 0, 1));
  for (Vertex& vertex : mesh.vertices) vertex.normal = bent;
  MorphTarget lift;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    lift.deltas.push_back({v, glm::vec3(0, 0, 1), {}, {}});
  }
  mesh.morph_targets.push_back(lift);
  ASSERT_TRUE(ComputeMorphNormals({true}, kNoLimit, &mesh).ok());
  for (const MorphDelta& delta : mesh.morph_targets[0].deltas) {
    EXPECT_EQ(delta.normal, glm::vec3(0.0f));
  }
  EXPECT_EQ(mesh.vertices[7].normal, bent);
}

// A sphere scaled along z against the exact normals of the ellipsoid.
TEST(MorphNormals, AgreeWithAnEllipsoid) {
  Mesh mesh;
  constexpr int kRings = 64, kSegments = 128;
  for (int r = 0; r <= kRings; ++r) {
    for (int s = 0; s <= kSegments; ++s) {  // the seam is doubled
      const float polar = 3.14159265f * float(r) / kRings;
      const float turn = 6.2831853f * float(s % kSegments) / kSegments;
      Vertex vertex;
      vertex.position = {std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                         std::cos(polar)};
      vertex.normal = vertex.position;
      mesh.vertices.push_back(vertex);
    }
  }
  for (std::uint32_t r = 0; r < kRings; ++r) {
    for (std::uint32_t s = 0; s < kSegments; ++s) {
      const std::uint32_t a = r * (kSegments + 1) + s, b = a + kSegments + 1;
      for (const std::uint32_t k : {a, b, b + 1, a, b + 1, a + 1}) mesh.indices.push_back(k);
    }
  }
  MorphTarget stretch;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    stretch.deltas.push_back({v, glm::vec3(0, 0, mesh.vertices[v].position.z), {}, {}});
  }
  mesh.morph_targets.push_back(stretch);
  ASSERT_TRUE(ComputeMorphNormals({true}, kNoLimit, &mesh).ok());
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const glm::vec3 p = mesh.vertices[v].position;
    if (std::abs(p.z) > 0.999f) continue;  // the vertices of a pole do not weld
    const glm::vec3 exact = glm::normalize(glm::vec3(p.x, p.y, p.z / 2.0f));
    EXPECT_LT(glm::distance(MorphedNormal(mesh, v), exact), 0.01f) << v;
  }
  // Both sides of the seam turn alike.
  const std::uint32_t first = 10 * (kSegments + 1);
  EXPECT_EQ(DeltaOf(mesh, first)->normal, DeltaOf(mesh, first + kSegments)->normal);
}

// Two sheets that touch at rest, of which one opens: the other one keeps its normals.
TEST(MorphNormals, DoNotCrossLips) {
  Mesh mesh = Sheet();
  Mesh other = Sheet();
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (Vertex& vertex : other.vertices) vertex.position.x += 1.0f;
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const std::uint32_t index : other.indices) mesh.indices.push_back(first + index);
  MorphTarget open;
  for (std::uint32_t v = first; v < mesh.vertices.size(); ++v) {
    open.deltas.push_back({v, glm::vec3(0, 0, mesh.vertices[v].position.x), {}, {}});
  }
  mesh.morph_targets.push_back(open);
  ASSERT_TRUE(ComputeMorphNormals({true}, kNoLimit, &mesh).ok());
  for (std::uint32_t v = 0; v < first; ++v) EXPECT_EQ(DeltaOf(mesh, v), nullptr);
  const glm::vec3 slope = glm::normalize(glm::vec3(-1, 0, 1));
  for (std::uint32_t v = first; v < mesh.vertices.size(); ++v) {
    EXPECT_LT(glm::distance(MorphedNormal(mesh, v), slope), 1e-5f) << v;
  }
}

TEST(MorphNormals, OnlyFlaggedTargetsChange) {
  Mesh mesh = Sheet();
  mesh.morph_targets = {{0, {{12, glm::vec3(0, 0, 1), glm::vec3(0.5f, 0, 0), {}}}},
                        {1, {{12, glm::vec3(0, 0, 1), {}, {}}}}};
  ASSERT_TRUE(ComputeMorphNormals({false, true}, kNoLimit, &mesh).ok());
  EXPECT_EQ(mesh.morph_targets[0].deltas.size(), 1u);
  EXPECT_EQ(mesh.morph_targets[0].deltas[0].normal, glm::vec3(0.5f, 0, 0));
  EXPECT_EQ(mesh.morph_targets[1].deltas.size(), 7u) << "a vertex and its six neighbours";
}

TEST(MorphNormals, AreLimited) {
  Mesh mesh = Sheet();
  mesh.morph_targets = {{0, {{12, glm::vec3(0, 0, 1), {}, {}}}}};
  EXPECT_EQ(ComputeMorphNormals({true}, 6, &mesh).code(), StatusCode::kLimit);
}

TEST(MorphNormals, SurviveFlatTriangles) {
  Mesh mesh = Sheet();
  for (Vertex& vertex : mesh.vertices) vertex.position = glm::vec3(0.0f);
  mesh.morph_targets = {{0, {{12, glm::vec3(0, 0, 1), {}, {}}}}};
  ASSERT_TRUE(ComputeMorphNormals({true}, kNoLimit, &mesh).ok());
  for (const MorphDelta& delta : mesh.morph_targets[0].deltas) {
    EXPECT_TRUE(std::isfinite(delta.normal.x));
  }
}

}  // namespace
}  // namespace furrow::character
