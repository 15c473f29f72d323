// SPDX-License-Identifier: Apache-2.0
#include "character/mesh/tangents.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

namespace furrow::character::paint {
namespace {

// Any unit vector across the normal, for vertices without usable UVs.
glm::vec3 AcrossOf(const glm::vec3& normal) {
  const glm::vec3 helper = std::abs(normal.x) < 0.8f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  return glm::normalize(helper - normal * glm::dot(normal, helper));
}

}  // namespace

void ComputeNormals(std::span<Vertex> vertices, std::span<const std::uint32_t> indices) {
  std::vector<glm::vec3> sums(vertices.size(), glm::vec3(0.0f));
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const std::uint32_t* corner = &indices[i];
    const glm::vec3& a = vertices[corner[0]].position;
    const glm::vec3& b = vertices[corner[1]].position;
    const glm::vec3& c = vertices[corner[2]].position;
    const glm::vec3 area = glm::cross(b - a, c - a);  // its length is twice the area
    for (int k = 0; k < 3; ++k) sums[corner[k]] += area;
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const float length = glm::length(sums[i]);
    const bool usable = length > 1e-30f && std::isfinite(length);
    vertices[i].normal = usable ? sums[i] / length : glm::vec3(0, 0, 1);
  }
}

void ComputeTangents(std::span<Vertex> vertices, std::span<const std::uint32_t> indices) {
  std::vector<glm::vec3> right(vertices.size(), glm::vec3(0.0f));
  std::vector<glm::vec3> up(vertices.size(), glm::vec3(0.0f));
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const std::uint32_t* corner = &indices[i];
    const Vertex& a = vertices[corner[0]];
    const Vertex& b = vertices[corner[1]];
    const Vertex& c = vertices[corner[2]];
    const glm::vec3 e1 = b.position - a.position;
    const glm::vec3 e2 = c.position - a.position;
    const glm::vec2 d1 = b.uv - a.uv;
    const glm::vec2 d2 = c.uv - a.uv;
    // Twice the triangle's area in UV space. Without it, the triangle has no tangent.
    const float det = d1.x * d2.y - d2.x * d1.y;
    if (!(std::abs(det) > 1e-20f)) continue;
    const float area = glm::length(glm::cross(e1, e2));
    const glm::vec3 along_u = (e1 * d2.y - e2 * d1.y) / det;
    const glm::vec3 against_v = (e1 * d2.x - e2 * d1.x) / det;  // -dP/dv
    const float u_length = glm::length(along_u);
    const float v_length = glm::length(against_v);
    if (!(u_length > 1e-20f && v_length > 1e-20f && std::isfinite(u_length + v_length))) continue;
    for (int k = 0; k < 3; ++k) {
      // Directions weighted by area, so that UV scale has no influence.
      right[corner[k]] += along_u * (area / u_length);
      up[corner[k]] += against_v * (area / v_length);
    }
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    Vertex& vertex = vertices[i];
    // Gram-Schmidt: the tangent is orthogonal to the vertex's own normal.
    const glm::vec3 flat = right[i] - vertex.normal * glm::dot(vertex.normal, right[i]);
    const float length = glm::length(flat);
    const bool usable = length > 1e-20f && std::isfinite(length);
    const glm::vec3 tangent = usable ? flat / length : AcrossOf(vertex.normal);
    const bool mirrored = glm::dot(glm::cross(vertex.normal, tangent), up[i]) < 0.0f;
    vertex.tangent = glm::vec4(tangent, mirrored ? -1.0f : 1.0f);
  }
}

}  // namespace furrow::character::paint
