// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "character/character.h"
#include "render/mesh/joint_bounds.h"

namespace furrow::render {

// The elements [first, first + count) of a list.
struct ElementRange {
  std::uint32_t first = 0;
  std::uint32_t count = 0;

  friend bool operator==(const ElementRange&, const ElementRange&) = default;
};

// Neighbouring triangles of a mesh, which a view sees or does not see together.
struct MeshCluster {
  ElementRange indices;                // of the mesh
  std::vector<ElementRange> vertices;  // contain all vertices of the triangles; ascending
  JointBounds bounds;                  // of the vertices of the triangles
  // How far a shape at weight 1 moves a vertex of the triangles at most, in the spaces of its
  // joints.
  struct Move {
    std::size_t shape = 0;
    float reach = 0.0f;
  };
  std::vector<Move> moves;

  // Upper bound of the way of any vertex by morph targets, in the spaces of its joints, where
  // bounds are: metres if the joints have no scale.
  [[nodiscard]] float MorphReach(std::span<const float> shapes) const;
};

struct ClusteredMesh {
  character::Mesh mesh;
  std::vector<MeshCluster> clusters;  // of all triangles, in their order
};

// What MakeClusters() may sort. Where surfaces of a mesh coincide, the order of its triangles is
// visible: the first one is drawn.
enum class Sorting {
  kByPlace,  // triangles by their place in the rest pose, and vertices by their first use
  kNone
};

// Divides the triangles of a mesh into clusters of at most kMaxClusterTriangles. The triangles of a
// cluster keep their order. Indices and morph targets must be in range.
inline constexpr std::size_t kMaxClusterTriangles = 384;
[[nodiscard]] ClusteredMesh MakeClusters(const character::Mesh& mesh,
                                         std::span<const glm::mat4> inverse_bind_matrices,
                                         Sorting sorting);

// The vertices that triangles use, in whole blocks: smaller ranges would be too many.
[[nodiscard]] std::vector<ElementRange> VertexBlocks(std::span<const std::uint32_t> indices,
                                                     std::size_t num_vertices);

// Joins overlapping and neighbouring ranges, also across gaps of at most `gap` elements. The result
// ascends.
[[nodiscard]] std::vector<ElementRange> Merged(std::vector<ElementRange> ranges,
                                               std::uint32_t gap = 0);

// The parts of `ranges` that `without` does not contain. Both ascend and do not overlap.
[[nodiscard]] std::vector<ElementRange> Difference(std::span<const ElementRange> ranges,
                                                   std::span<const ElementRange> without);

}  // namespace furrow::render
