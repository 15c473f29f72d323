// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace furrow::character {

// How far a morph target at weight 1 moves one vertex, in model space in the rest pose. Deltas are
// added before skinning and are linear in the weight (glTF 2.0, section 3.7.2.2).
struct MorphDelta {
  std::uint32_t vertex = 0;  // index into Mesh::vertices
  glm::vec3 position{0.0f};  // metres
  glm::vec3 normal{0.0f};    // added to the unit normal; the sum is normalised
  glm::vec3 tangent{0.0f};   // added to the tangent's xyz; the sum is normalised
};

// One morph target of a mesh. It holds only the vertices that it moves.
struct MorphTarget {
  int shape = 0;                   // index into Character::shapes
  std::vector<MorphDelta> deltas;  // ascending by vertex, at most one per vertex; not empty
};

// Limit of Character::shapes, and so of the targets of one mesh.
inline constexpr std::size_t kMaxShapes = 512;

}  // namespace furrow::character
