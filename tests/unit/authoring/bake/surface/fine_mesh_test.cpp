// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/surface/fine_mesh.h"

#include <cmath>
#include <map>
#include <random>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

// A wavy sheet whose cells are of very different sizes.
character::Mesh Wavy() {
  return toys::Grid(9, 7, [](float u, float v) {
    toys::Point point;
    point.position = {u * u * 0.4f, v * 0.3f, 0.03f * std::sin(9.0f * u) * std::cos(7.0f * v)};
    point.uv = {u, 1.0f - v};
    return point;
  });
}

float AreaOf(const FineMesh& mesh, const FineMesh::Triangle& t) {
  const auto p = mesh.positions();
  return 0.5f * glm::length(glm::cross(p[t.vertices[1]] - p[t.vertices[0]],
                                       p[t.vertices[2]] - p[t.vertices[0]]));
}

TEST(FineMesh, CoversTheSurfaceWithShortEdges) {
  const character::Mesh sheet = Wavy();
  const character::Mesh* const meshes[] = {&sheet};
  const Surface surface(meshes);
  constexpr float kEdge = 0.012f;
  const FineMesh mesh(surface, kEdge);
  for (const FineMesh::Edge& edge : mesh.edges()) {
    EXPECT_LE(glm::distance(mesh.positions()[edge[0]], mesh.positions()[edge[1]]),
              4.0f / 3.0f * kEdge + 1e-6f);
  }
  double area = 0.0, wanted = 0.0;
  for (const FineMesh::Triangle& t : mesh.triangles()) area += double{AreaOf(mesh, t)};
  for (const Surface::Triangle& t : surface.triangles()) wanted += double{t.area};
  EXPECT_NEAR(area, wanted, 1e-5 * wanted);
}

// Every edge inside belongs to two triangles: halved edges are halved on both sides.
TEST(FineMesh, HasNoGaps) {
  const character::Mesh sheet = Wavy();
  const character::Mesh* const meshes[] = {&sheet};
  const Surface surface(meshes);
  const FineMesh mesh(surface, 0.01f);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const FineMesh::Triangle& t : mesh.triangles()) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++uses[std::minmax(t.vertices[k], t.vertices[(k + 1) % 3])];
    }
  }
  EXPECT_EQ(uses.size(), mesh.edges().size());
  int border = 0;
  for (const auto& [edge, count] : uses) {
    EXPECT_LE(count, 2);
    if (count != 1) continue;
    ++border;
    for (const std::uint32_t v : {edge.first, edge.second}) {
      const vec3 p = mesh.positions()[v];
      const bool on_border = p.x < 1e-6f || p.x > 0.4f - 1e-6f || p.y < 1e-6f || p.y > 0.3f - 1e-6f;
      EXPECT_TRUE(on_border);
    }
  }
  EXPECT_GT(border, 0);
}

TEST(FineMesh, FindsAnyPointOfTheSurface) {
  const character::Mesh sheet = Wavy();
  const character::Mesh* const meshes[] = {&sheet};
  const Surface surface(meshes);
  const FineMesh mesh(surface, 0.01f);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (int i = 0; i < 2000; ++i) {
    const auto t = static_cast<std::uint32_t>(random() % surface.triangles().size());
    float a = unit(random), b = unit(random);
    if (a + b > 1.0f) {
      a = 1.0f - a;
      b = 1.0f - b;
    }
    const SurfacePoint point = surface.PointOf(t, {1.0f - a - b, a, b});
    const FineMesh::Place place = mesh.Find(point);
    const auto& v = mesh.triangles()[place.triangle].vertices;
    vec3 found(0.0f);
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(place.corners[k], -1e-3f);
      found += place.corners[k] * mesh.positions()[v[static_cast<std::size_t>(k)]];
    }
    EXPECT_LT(glm::distance(found, point.position), 1e-5f);
  }
}

TEST(FineMesh, InterpolatesValuesOfTheSurface) {
  const character::Mesh sheet = Wavy();
  const character::Mesh* const meshes[] = {&sheet};
  const Surface surface(meshes);
  const FineMesh mesh(surface, 0.01f);
  std::vector<float> heights;
  for (const vec3& p : surface.positions()) heights.push_back(p.z);
  for (std::size_t v = 0; v < mesh.vertices().size(); ++v) {
    EXPECT_NEAR(mesh.vertices()[v].Interpolate(std::span<const float>(heights)),
                mesh.positions()[v].z, 1e-6f);
  }
}

}  // namespace
}  // namespace furrow::authoring
