// SPDX-License-Identifier: Apache-2.0
#include "authoring/shapes/morph.h"

#include <cstddef>
#include <cstdint>

#include <glm/geometric.hpp>

namespace furrow::authoring {

std::vector<glm::vec3> MorphedPositions(const character::Mesh& mesh,
                                        std::span<const float> weights) {
  std::vector<glm::vec3> positions;
  positions.reserve(mesh.vertices.size());
  for (const character::Vertex& vertex : mesh.vertices) positions.push_back(vertex.position);
  for (const character::MorphTarget& target : mesh.morph_targets) {
    const auto shape = static_cast<std::size_t>(target.shape);
    const float weight = shape < weights.size() ? weights[shape] : 0.0f;
    if (weight == 0.0f) continue;
    for (const character::MorphDelta& delta : target.deltas) {
      positions[delta.vertex] += weight * delta.position;
    }
  }
  return positions;
}

std::vector<glm::vec3> SurfaceNormals(std::span<const glm::vec3> positions,
                                      std::span<const std::uint32_t> indices,
                                      std::span<const std::uint32_t> welded) {
  std::vector<glm::vec3> sums(positions.size(), glm::vec3(0.0f));
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const glm::vec3& a = positions[indices[i]];
    const glm::vec3 n = glm::cross(positions[indices[i + 1]] - a, positions[indices[i + 2]] - a);
    for (std::size_t k = 0; k < 3; ++k) sums[welded[indices[i + k]]] += n;
  }
  std::vector<glm::vec3> normals(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const glm::vec3& n = sums[welded[v]];
    normals[v] = glm::length(n) > 0.0f ? glm::normalize(n) : glm::vec3(0.0f, 0.0f, 1.0f);
  }
  return normals;
}

}  // namespace furrow::authoring
