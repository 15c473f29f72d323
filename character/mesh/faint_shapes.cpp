// SPDX-License-Identifier: Apache-2.0
#include "character/mesh/faint_shapes.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace furrow::character {
namespace {

// What the shapes of all meshes do.
struct Moves {
  std::vector<float> longest;  // per shape
  float extent = 0.0f;         // of all points that any shape moves
};

Moves MeasureMoves(std::span<const Mesh> meshes, std::size_t num_shapes) {
  Moves moves{.longest = std::vector<float>(num_shapes, 0.0f)};
  glm::vec3 low(std::numeric_limits<float>::max());
  glm::vec3 high(std::numeric_limits<float>::lowest());
  bool any = false;
  for (const Mesh& mesh : meshes) {
    for (const MorphTarget& target : mesh.morph_targets) {
      float& longest = moves.longest[static_cast<std::size_t>(target.shape)];
      for (const MorphDelta& delta : target.deltas) {
        const float length = glm::length(delta.position);
        if (length == 0.0f) continue;
        longest = std::max(longest, length);
        low = glm::min(low, mesh.vertices[delta.vertex].position);
        high = glm::max(high, mesh.vertices[delta.vertex].position);
        any = true;
      }
    }
  }
  const glm::vec3 size = high - low;
  if (any) moves.extent = std::max({size.x, size.y, size.z});
  return moves;
}

}  // namespace

std::vector<std::string> DropFaintShapes(std::vector<std::string>* shapes,
                                         std::vector<Mesh>* meshes) {
  const Moves moves = MeasureMoves(*meshes, shapes->size());
  const float least = kLeastShapeMove * moves.extent;
  std::vector<std::string> dropped;
  std::vector<std::string> kept;
  std::vector<int> index;  // old to new; -1: dropped
  for (std::size_t i = 0; i < shapes->size(); ++i) {
    const bool faint = moves.longest[i] > 0.0f && moves.longest[i] < least;
    index.push_back(faint ? -1 : static_cast<int>(kept.size()));
    (faint ? dropped : kept).push_back(std::move((*shapes)[i]));
  }
  *shapes = std::move(kept);
  if (dropped.empty()) return dropped;
  for (Mesh& mesh : *meshes) {
    for (MorphTarget& target : mesh.morph_targets) {
      target.shape = index[static_cast<std::size_t>(target.shape)];
    }
    std::erase_if(mesh.morph_targets, [](const MorphTarget& target) { return target.shape < 0; });
  }
  return dropped;
}

}  // namespace furrow::character
