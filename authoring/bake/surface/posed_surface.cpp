// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/surface/posed_surface.h"

#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace furrow::authoring {
namespace {

using glm::vec3;

// A rotation and a translation as a unit dual quaternion: `dual` = 1/2 translation * rotation.
struct RigidMotion {
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
  glm::quat dual{0.0f, 0.0f, 0.0f, 0.0f};

  [[nodiscard]] vec3 Apply(const vec3& p) const {
    const glm::quat shift = 2.0f * (dual * glm::conjugate(rotation));
    return rotation * p + vec3(shift.x, shift.y, shift.z);
  }
};

// Returns nothing if a matrix is not rigid.
std::optional<std::vector<RigidMotion>> RigidMotions(std::span<const glm::mat4> matrices) {
  constexpr float kTolerance = 1e-3f;
  std::vector<RigidMotion> motions;
  for (const glm::mat4& matrix : matrices) {
    const glm::mat3 turn(matrix);
    const glm::mat3 square = glm::transpose(turn) * turn;
    for (int k = 0; k < 9; ++k) {
      const float expected = k % 4 == 0 ? 1.0f : 0.0f;
      if (std::abs(square[k / 3][k % 3] - expected) > kTolerance) return std::nullopt;
    }
    if (glm::determinant(turn) < 0.0f) return std::nullopt;
    RigidMotion motion;
    motion.rotation = glm::normalize(glm::quat_cast(turn));
    const vec3 shift(matrix[3]);
    motion.dual = 0.5f * (glm::quat(0.0f, shift.x, shift.y, shift.z) * motion.rotation);
    motions.push_back(motion);
  }
  return motions;
}

// Dual quaternion linear blending: the weighted sum, normalised to a rigid motion.
RigidMotion Blend(const std::vector<RigidMotion>& motions, const character::Vertex& vertex) {
  const glm::quat pivot = motions[vertex.joints[0]].rotation;  // the strongest influence
  RigidMotion sum{glm::quat(0.0f, 0.0f, 0.0f, 0.0f), glm::quat(0.0f, 0.0f, 0.0f, 0.0f)};
  for (int k = 0; k < 4; ++k) {
    const RigidMotion& motion = motions[vertex.joints[k]];
    // q and -q are the same rotation. Use the one in the pivot's hemisphere.
    const float side = glm::dot(motion.rotation, pivot) < 0.0f ? -1.0f : 1.0f;
    const float weight = side * vertex.skin_weights[k];
    sum.rotation = sum.rotation + motion.rotation * weight;
    sum.dual = sum.dual + motion.dual * weight;
  }
  const float length = glm::length(sum.rotation);
  // Opposite rotations may cancel out; the strongest joint then decides.
  if (!(length > 1e-6f)) return motions[vertex.joints[0]];
  sum.rotation = sum.rotation * (1.0f / length);
  sum.dual = sum.dual * (1.0f / length);
  // Makes the dual part orthogonal to the rotation again. Otherwise the blend would not be rigid.
  sum.dual = sum.dual - sum.rotation * glm::dot(sum.rotation, sum.dual);
  return sum;
}

}  // namespace

std::vector<PosedVertex> PoseSurface(const Surface& surface,
                                     std::span<const glm::mat4> skin_matrices,
                                     std::span<const vec3> positions) {
  const std::optional<std::vector<RigidMotion>> motions = RigidMotions(skin_matrices);
  std::vector<PosedVertex> posed;
  posed.reserve(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const character::Vertex& vertex = surface.SourceOf(v);
    const vec3 rest = positions[v];
    if (motions) {
      const RigidMotion motion = Blend(*motions, vertex);
      posed.push_back({motion.Apply(rest), glm::mat3_cast(motion.rotation)});
      continue;
    }
    glm::mat4 sum(0.0f);
    for (int k = 0; k < 4; ++k) sum += vertex.skin_weights[k] * skin_matrices[vertex.joints[k]];
    posed.push_back({vec3(sum * glm::vec4(rest, 1.0f)), glm::mat3(sum)});
  }
  return posed;
}

}  // namespace furrow::authoring
