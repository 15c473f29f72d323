// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "authoring/bake/surface/fine_mesh.h"

namespace furrow::authoring {

// The cosine between normals below which two places are on different sides of a garment.
inline constexpr float kSameSide = 0.2f;

// The direction of `v`, or `otherwise` if it has none.
[[nodiscard]] inline glm::vec3 UnitOr(const glm::vec3& v, const glm::vec3& otherwise) {
  const float length = glm::length(v);
  return length > 1e-9f ? v / length : otherwise;
}
[[nodiscard]] inline float TraceOf(const glm::mat3& m) { return m[0][0] + m[1][1] + m[2][2]; }

// The normals of a mesh's vertices at rest: means of its triangles, weighted by area.
[[nodiscard]] std::vector<glm::vec3> NormalsOf(const FineMesh& mesh);
// The gradient of a value per vertex over a mesh at rest, per metre: means of its triangles.
[[nodiscard]] std::vector<glm::vec3> SlopesOf(const FineMesh& mesh,
                                              const std::vector<float>& values);
// The mean of the squared lengths of a mesh's edges, square metres; 0 without edges.
[[nodiscard]] float MeanSquaredEdge(const FineMesh& mesh);
// Averages each value with those around it, `passes` times.
template <class T>
void SmoothOver(const FineMesh& mesh, int passes, std::vector<T>* values) {
  std::vector<T> next(values->size());
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t v = 0; v < values->size(); ++v) {
      T sum = (*values)[v];
      for (const std::uint32_t other : mesh.Around(v)) sum += (*values)[other];
      next[v] = sum / static_cast<float>(mesh.Around(v).size() + 1);
    }
    values->swap(next);
  }
}

}  // namespace furrow::authoring
