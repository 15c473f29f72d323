// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "character/mesh/mesh.h"

namespace furrow::render {

// The weight with which a shape is drawn: `weight`, but 0 if nobody would see the difference, and
// at most 2 in either direction, because a tracker's error must not tear the face.
[[nodiscard]] float DrawnShapeWeight(float weight);

// The morph targets of a mesh, packed so that their sum for one face is cheap: only vertices that
// some target moves have a row, and a target's rows are read as long runs of numbers.
//
// A row is 3 * num_parts() floats: the moves of the position (metres), the normal and the tangent,
// model space, rest pose. Parts that no target of the mesh has are left out.
class MeshMorphs {
 public:
  MeshMorphs() = default;  // no targets
  // The targets' vertices must be in range. Keeps no reference to `mesh`.
  explicit MeshMorphs(const character::Mesh& mesh);

  [[nodiscard]] bool empty() const { return targets_.empty(); }
  // Row of each vertex of the mesh; 0 for vertices that no target moves.
  [[nodiscard]] std::span<const std::uint32_t> rows() const { return rows_; }
  [[nodiscard]] std::size_t num_rows() const { return num_rows_; }  // row 0 included
  // 1: positions; 2: also normals; 3: also tangents.
  [[nodiscard]] std::size_t num_parts() const { return num_parts_; }
  [[nodiscard]] std::size_t num_floats() const { return num_rows_ * 3 * num_parts_; }

  // The targets with their moves of positions, as far as this mesh has them.
  [[nodiscard]] std::vector<character::MorphTarget> Positions() const;

  // `shapes` below: weights of the character's shapes; missing ones count as 0.

  // Appends the drawn weights of this mesh's shapes. Equal weights give equal sums.
  void AppendWeights(std::span<const float> shapes, std::vector<float>* weights) const;
  // True if some shape moves the mesh.
  [[nodiscard]] bool Moves(std::span<const float> shapes) const;
  // Writes num_floats() floats: each row's sum of delta * weight. Row 0 is 0.
  void Sum(std::span<const float> shapes, std::span<float> sums) const;
  // Upper bound, in metres, of the way of a vertex from its rest pose.
  [[nodiscard]] float Reach(std::span<const float> shapes) const;

 private:
  // Consecutive rows that a target moves.
  struct Run {
    std::uint32_t row = 0;
    std::uint32_t num_rows = 0;
  };
  struct Target {
    std::size_t shape = 0;
    float reach = 0.0f;  // longest move of a vertex at weight 1, metres
    std::vector<Run> runs;
    std::vector<float> deltas;  // of all runs, row after row
  };
  void NumberRows(const character::Mesh& mesh);
  void AddTarget(const character::MorphTarget& source);

  std::vector<Target> targets_;
  std::vector<std::uint32_t> rows_;
  std::size_t num_rows_ = 0;
  std::size_t num_parts_ = 0;
};

}  // namespace furrow::render
