// SPDX-License-Identifier: Apache-2.0
#include "render/mesh/uv_density.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

namespace furrow::render {
namespace {

// Largest UV distance per metre of a triangle, over all directions; 0: degenerate.
float UvPerMetre(const character::Vertex& a, const character::Vertex& b,
                 const character::Vertex& c) {
  const glm::vec3 side = b.position - a.position;
  const float length = glm::length(side);
  if (!(length > 0.0f)) return 0.0f;
  const glm::vec3 x = side / length;
  const glm::vec3 other = c.position - a.position;
  const float along = glm::dot(other, x);
  const float across = glm::length(other - along * x);
  if (!(across > 0.0f)) return 0.0f;
  // Derivatives of the UV along the triangle's orthonormal axes: along its first side, and across
  // it.
  const glm::vec2 du = (b.uv - a.uv) / length;
  const glm::vec2 dv = (c.uv - a.uv - along * du) / across;
  // The larger singular value of (du dv).
  const float sum = glm::dot(du, du) + glm::dot(dv, dv);
  const float cross = du.x * dv.y - du.y * dv.x;
  const float root = std::sqrt(std::max(sum * sum - 4.0f * cross * cross, 0.0f));
  return std::sqrt(0.5f * (sum + root));
}

}  // namespace

float MinUvPerMetre(const character::Mesh& mesh) {
  // Share of the area that may have less UV per metre than the result: a few triangles that are
  // stretched in the texture must not decide for the whole mesh.
  constexpr double kOutliers = 0.05;
  std::vector<std::pair<float, double>> triangles;  // UV per metre, area
  double surface = 0.0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const character::Vertex& a = mesh.vertices[mesh.indices[i]];
    const character::Vertex& b = mesh.vertices[mesh.indices[i + 1]];
    const character::Vertex& c = mesh.vertices[mesh.indices[i + 2]];
    const float uv = UvPerMetre(a, b, c);
    if (!(uv > 0.0f)) continue;
    triangles.emplace_back(
        uv, glm::length(glm::cross(b.position - a.position, c.position - a.position)));
    surface += triangles.back().second;
  }
  std::ranges::sort(triangles);
  double below = 0.0;
  for (const auto& [uv, area] : triangles) {
    below += area;
    if (below >= kOutliers * surface) return uv;
  }
  return 0.0f;
}

}  // namespace furrow::render
