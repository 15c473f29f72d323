// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/cloth/sheet_math.h"

#include <algorithm>

namespace furrow::authoring {

using glm::vec3;

std::vector<vec3> NormalsOf(const FineMesh& mesh) {
  std::vector<vec3> normals(mesh.positions().size(), vec3(0.0f));
  const auto p = mesh.positions();
  for (const FineMesh::Triangle& triangle : mesh.triangles()) {
    const auto& v = triangle.vertices;
    const vec3 area = glm::cross(p[v[1]] - p[v[0]], p[v[2]] - p[v[0]]);
    for (const std::uint32_t corner : v) normals[corner] += area;
  }
  for (vec3& normal : normals) normal = UnitOr(normal, vec3(0.0f, 0.0f, 1.0f));
  return normals;
}

// The slopes of a value over a mesh at rest.
std::vector<vec3> SlopesOf(const FineMesh& mesh, const std::vector<float>& values) {
  std::vector<vec3> slopes(values.size(), vec3(0.0f));
  std::vector<float> areas(values.size(), 0.0f);
  const auto p = mesh.positions();
  for (const FineMesh::Triangle& triangle : mesh.triangles()) {
    const auto& v = triangle.vertices;
    const vec3 area = glm::cross(p[v[1]] - p[v[0]], p[v[2]] - p[v[0]]);
    const float twice = glm::length(area);
    if (!(twice > 1e-12f)) continue;
    vec3 slope(0.0f);
    for (std::size_t k = 0; k < 3; ++k) {
      const vec3 edge = p[v[(k + 2) % 3]] - p[v[(k + 1) % 3]];
      slope += values[v[k]] * glm::cross(area, edge) / (twice * twice);
    }
    for (const std::uint32_t corner : v) {
      slopes[corner] += twice * slope;
      areas[corner] += twice;
    }
  }
  for (std::size_t i = 0; i < slopes.size(); ++i) slopes[i] /= std::max(areas[i], 1e-12f);
  return slopes;
}

float MeanSquaredEdge(const FineMesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b] : mesh.edges()) {
    const vec3 edge = mesh.positions()[b] - mesh.positions()[a];
    sum += static_cast<double>(glm::dot(edge, edge));
  }
  return static_cast<float>(sum /
                            static_cast<double>(std::max<std::size_t>(mesh.edges().size(), 1)));
}

}  // namespace furrow::authoring
