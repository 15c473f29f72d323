// SPDX-License-Identifier: Apache-2.0
#include "character/paint/tangents.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

namespace furrow::character::paint {
namespace {

glm::vec3 AnyOrthogonal(const glm::vec3& n) {
  const glm::vec3 axis = std::abs(n.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  return glm::normalize(glm::cross(axis, n));
}

glm::vec3 NormalizeOr(const glm::vec3& v, const glm::vec3& fallback) {
  const float length = glm::length(v);
  return length > 1e-12f ? v / length : fallback;
}

}  // namespace

void ComputeTangents(std::span<Vertex> vertices, std::span<const std::uint32_t> indices) {
  std::vector<glm::vec3> along_u(vertices.size(), glm::vec3(0.0f));
  std::vector<glm::vec3> up(vertices.size(), glm::vec3(0.0f));
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const Vertex& a = vertices[indices[i]];
    const Vertex& b = vertices[indices[i + 1]];
    const Vertex& c = vertices[indices[i + 2]];
    const glm::vec3 e1 = b.position - a.position;
    const glm::vec3 e2 = c.position - a.position;
    const glm::vec2 d1 = b.uv - a.uv;
    const glm::vec2 d2 = c.uv - a.uv;
    const float area = d1.x * d2.y - d2.x * d1.y;
    if (std::abs(area) < 1e-14f) continue;
    const float sign = area < 0.0f ? -1.0f : 1.0f;  // weights by area: no division
    for (int k = 0; k < 3; ++k) {
      along_u[indices[i + k]] += (e1 * d2.y - e2 * d1.y) * sign;
      up[indices[i + k]] -= (e2 * d1.x - e1 * d2.x) * sign;
    }
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const glm::vec3 n = vertices[i].normal;
    const glm::vec3 t = along_u[i] - n * glm::dot(n, along_u[i]);
    const glm::vec3 tangent = NormalizeOr(t, AnyOrthogonal(n));
    const float w = glm::dot(glm::cross(n, tangent), up[i]) < 0.0f ? -1.0f : 1.0f;
    vertices[i].tangent = glm::vec4(tangent, w);
  }
}

}  // namespace furrow::character::paint
