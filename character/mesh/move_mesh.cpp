// SPDX-License-Identifier: Apache-2.0
#include "character/mesh/move_mesh.h"

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace furrow::character {
namespace {

// How one vertex moves. `normals` and `tangents` include the factor that makes the vertex's own
// direction a unit vector again: a delta needs the same factor, because it is added before the sum
// is normalised.
struct Move {
  glm::mat3 positions{1.0f};
  glm::mat3 normals{1.0f};
  glm::mat3 tangents{1.0f};
};

// `m` over the length of the moved direction; the identity if that has no length.
glm::mat3 ScaledToUnit(const glm::mat3& m, const glm::vec3& direction) {
  const float length = glm::length(m * direction);
  return length > 1e-12f && std::isfinite(length) ? m / length : glm::mat3(1.0f);
}

Move MoveOf(const glm::mat4& matrix, const Vertex& vertex) {
  const glm::mat3 axes(matrix);
  const float determinant = glm::determinant(axes);
  // A flat matrix has no inverse.
  const bool flat = !(std::abs(determinant) > 1e-30f);
  const glm::mat3 normals = flat ? axes : glm::transpose(glm::inverse(axes));
  return {axes, ScaledToUnit(normals, vertex.normal),
          ScaledToUnit(axes, glm::vec3(vertex.tangent))};
}

void MoveVertex(const glm::mat4& matrix, const Move& move, Vertex* vertex) {
  vertex->position = glm::vec3(matrix * glm::vec4(vertex->position, 1.0f));
  vertex->normal = move.normals * vertex->normal;
  vertex->tangent = glm::vec4(move.tangents * glm::vec3(vertex->tangent), vertex->tangent.w);
}

}  // namespace

void MoveMesh(const VertexMatrix& matrix_of, Mesh* mesh) {
  const bool morphs = !mesh->morph_targets.empty();
  std::vector<Move> moves;
  if (morphs) moves.reserve(mesh->vertices.size());
  bool mirrored = false;
  for (Vertex& vertex : mesh->vertices) {
    const glm::mat4 matrix = matrix_of(vertex);
    const Move move = MoveOf(matrix, vertex);
    mirrored = mirrored || glm::determinant(move.positions) < 0.0f;
    MoveVertex(matrix, move, &vertex);
    if (morphs) moves.push_back(move);
  }
  for (MorphTarget& target : mesh->morph_targets) {
    for (MorphDelta& delta : target.deltas) {
      const Move& move = moves[delta.vertex];
      delta.position = move.positions * delta.position;
      delta.normal = move.normals * delta.normal;
      delta.tangent = move.tangents * delta.tangent;
    }
  }
  if (!mirrored) return;
  for (std::size_t i = 0; i + 2 < mesh->indices.size(); i += 3) {
    std::swap(mesh->indices[i + 1], mesh->indices[i + 2]);
  }
}

}  // namespace furrow::character
