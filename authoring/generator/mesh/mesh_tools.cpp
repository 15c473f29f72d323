// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/mesh/mesh_tools.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <glm/geometric.hpp>

#include "character/mesh/tangents.h"
#include "wrinkle/drivers/strain/strain.h"

namespace furrow::authoring {
namespace {

constexpr float kSamePlace = 1e-6f;  // metres

void AddTriangle(character::Mesh* mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const glm::vec3& pa = mesh->vertices[a].position;
  const glm::vec3& pb = mesh->vertices[b].position;
  const glm::vec3& pc = mesh->vertices[c].position;
  if (!wrinkle::MakeRestTriangle(pa, pb, pc, {})) return;  // degenerate
  mesh->indices.insert(mesh->indices.end(), {a, b, c});
}

// A key for vertices at the same position. They share a normal across UV seams.
std::array<long, 3> Place(const glm::vec3& p) {
  return {std::lround(p.x / kSamePlace), std::lround(p.y / kSamePlace),
          std::lround(p.z / kSamePlace)};
}

}  // namespace

void AddQuad(character::Mesh* mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c,
             std::uint32_t d) {
  const auto& v = mesh->vertices;
  // Splits along the shorter diagonal, which follows the shape better.
  if (glm::distance(v[a].position, v[c].position) <= glm::distance(v[b].position, v[d].position)) {
    AddTriangle(mesh, a, b, c);
    AddTriangle(mesh, a, c, d);
  } else {
    AddTriangle(mesh, a, b, d);
    AddTriangle(mesh, b, c, d);
  }
}

void FinishSurface(character::Mesh* mesh) {
  std::map<std::array<long, 3>, glm::vec3> normals;
  for (std::size_t i = 0; i + 2 < mesh->indices.size(); i += 3) {
    const character::Vertex& a = mesh->vertices[mesh->indices[i]];
    const character::Vertex& b = mesh->vertices[mesh->indices[i + 1]];
    const character::Vertex& c = mesh->vertices[mesh->indices[i + 2]];
    const glm::vec3 n = glm::cross(b.position - a.position, c.position - a.position);
    for (int k = 0; k < 3; ++k) normals[Place(mesh->vertices[mesh->indices[i + k]].position)] += n;
  }
  for (character::Vertex& vertex : mesh->vertices) {
    const glm::vec3 n = normals[Place(vertex.position)];
    vertex.normal = glm::length(n) > 0.0f ? glm::normalize(n) : glm::vec3(0, 0, 1);
  }
  character::paint::ComputeTangents(mesh->vertices, mesh->indices);
}

float Interpolate(std::span<const Knot> knots, float x) {
  if (x <= knots.front().first) return knots.front().second;
  for (std::size_t i = 1; i < knots.size(); ++i) {
    if (x > knots[i].first) continue;
    const auto& [x0, y0] = knots[i - 1];
    const auto& [x1, y1] = knots[i];
    return y0 + (y1 - y0) * (x - x0) / (x1 - x0);
  }
  return knots.back().second;
}

float Bump(float x, float width) { return std::exp(-(x / width) * (x / width)); }

}  // namespace furrow::authoring
