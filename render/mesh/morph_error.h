// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "character/mesh/mesh.h"

namespace furrow::render {

// How far the morph targets of a mesh move the surface away from a simplified one.
class MorphError {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  explicit MorphError(const character::Mesh& mesh);

  // True if no target moves any vertex.
  [[nodiscard]] bool empty() const { return deltas_.empty(); }
  // How far, at most, the targets move a point of the surface away from the surface without
  // `vertex`, in metres: the largest of all targets, each at weight 1. Distances along the surface
  // count as well, because textures slide with it. `before`: the triangles of the vertex; `after`:
  // those that take their place; `positions`: of the mesh's vertices in the rest pose.
  //
  // Both surfaces move linearly within a triangle, so they are farthest apart at the vertex or on
  // one of its edges. The edges are sampled.
  [[nodiscard]] double Between(std::uint32_t vertex, std::span<const Triangle> before,
                               std::span<const Triangle> after,
                               std::span<const glm::dvec3> positions);
  // The same at the vertex alone, which costs a tenth.
  [[nodiscard]] double AtVertex(std::uint32_t vertex, std::span<const Triangle> after,
                                std::span<const glm::dvec3> positions);

 private:
  struct Delta {
    std::uint32_t target;
    glm::vec3 position;  // metres
  };
  void Add(std::uint32_t vertex, double share);
  void SubtractPlace(const glm::dvec3& point, std::span<const Triangle> triangles,
                     std::span<const glm::dvec3> positions);
  // The longest sum. Resets the sums.
  [[nodiscard]] double TakeLongest();

  std::vector<std::size_t> first_;  // of a vertex in deltas_; one more than vertices
  std::vector<Delta> deltas_;
  // The sums of one point, by target; 0 between the calls.
  std::vector<glm::dvec3> sums_;
  std::vector<std::uint32_t> touched_;
};

}  // namespace furrow::render
