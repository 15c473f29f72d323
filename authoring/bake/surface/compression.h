// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "authoring/bake/request/bake_progress.h"
#include "authoring/bake/surface/posed_surface.h"
#include "authoring/bake/surface/surface.h"

namespace furrow::authoring {

// The eigenvalues of a symmetric tensor, and the direction of the larger one in the tensor's axes.
struct Principal2 {
  float large = 0.0f;
  float small = 0.0f;
  glm::vec2 direction{1.0f, 0.0f};  // unit vector, of either sign
};
// The eigenvalues and the principal direction of `tensor`.
[[nodiscard]] Principal2 PrincipalOf(const Tensor2& tensor);

// Computes how a pose compresses a surface at each vertex.
//
// - PoseSurface() moves the surface.
// - A stretch is negative where the pose turns the surface inside out, as inside a sharply bent
//   knee. Lengths alone would not show that such a surface is more than fully compressed.
//
// Skinning strains triangles unevenly, and the strain must not be finer than the folds it causes.
// The stretch of the triangles (right stretch tensor U, C = U^2) is therefore averaged over a
// radius, weighted by area and a Gaussian of the distance. Each tensor is transported over the
// surface to the vertex. If very many triangles lie within the radius, a sample of them is used, so
// memory grows only with the number of vertices.
class CompressionSolver {
 public:
  // `surface` must outlive the solver. `radius`: of the average, metres, >= 0 (0: only the
  // triangles around the vertex). If `progress` cancels, the solver is incomplete and must not be
  // used.
  CompressionSolver(const Surface& surface, float radius, BakeProgress* progress);

  struct Field {
    // One per welded vertex, in its axes: 1 - stretch along the principal directions, [0, 1]; 0
    // where the surface is stretched.
    std::vector<Tensor2> tensors;
    std::vector<float> growth;  // one per welded vertex: area relative to rest, [0, (1 + limit)^2]
    float worst = 0.0f;         // largest compression of any triangle, before averaging
  };
  // Solves one pose. `skin_matrices`: one per joint of the skeleton. `shape_weights`: one per shape
  // of the character, or none. `limit`: a larger compression counts as this, (0, 1).
  // Under shapes, slivers (longer than 12 times their height) count as unstrained, because the
  // strain of their short side is noise.
  [[nodiscard]] Field Solve(std::span<const glm::mat4> skin_matrices,
                            std::span<const float> shape_weights, float limit) const;

  // The total number of triangles in the averages of all vertices.
  [[nodiscard]] std::size_t num_terms() const { return terms_.size(); }

 private:
  struct Term {
    std::uint32_t triangle;
    float share;  // the shares of a vertex sum to 1
    PlaneRotation turn;
  };

  [[nodiscard]] bool IsSliver(std::size_t triangle) const;
  [[nodiscard]] Tensor2 StretchOf(std::size_t triangle, std::span<const PosedVertex> posed,
                                  float limit, float* worst) const;
  static void LimitTerms(std::vector<Term>* terms);
  void Gather(std::size_t vertex, float radius, SurfaceSearch* reach, std::vector<Term>* terms);

  const Surface& surface_;
  std::vector<Term> terms_;
  std::vector<std::size_t> starts_;
};

// Combines the poses that feed one map into one field: approximately the largest compression in
// each direction. Poses that compress one place along different directions give it a second
// principal compression, and folds that cross.
class CompressionSum {
 public:
  explicit CompressionSum(std::size_t vertices) : sums_(vertices) {}
  // Adds a pose. `tensors`: Field::tensors. `weights`: one per vertex, multipliers in [0, 1].
  void Add(std::span<const Tensor2> tensors, std::span<const float> weights);
  // Returns the combined compression, one tensor per vertex, in the vertex's axes.
  [[nodiscard]] std::vector<Tensor2> Take() const;

 private:
  std::vector<Tensor2> sums_;  // sums of the fourth powers of the tensors
};

}  // namespace furrow::authoring
