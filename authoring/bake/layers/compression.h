// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "authoring/bake/pace.h"
#include "authoring/bake/surface/surface.h"

namespace furrow::character::bake {

// Eigenvalues and the direction of the larger, in the tensor's axes.
struct Principal2 {
  float large = 0.0f;
  float small = 0.0f;
  glm::vec2 direction{1.0f, 0.0f};  // unit, up to sign
};
[[nodiscard]] Principal2 PrincipalOf(const Tensor2& tensor);

// How a pose compresses a surface, vertex by vertex.
//
// - Joints' motions are blended as dual quaternions (Kavan et al. 2007), not linearly as they are
//   drawn: linear blending flattens a bent limb, which would seem to fold it lengthwise. Where a
//   skin matrix is not rigid, linearly after all.
// - A stretch counts as negative where the pose turns the surface inside out, as it does inside a
//   sharply bent knee: that is more than fully compressed, though lengths do not say so.
//
// Skinning strains triangles unevenly, and a fold is no finer than the strain it answers to: so the
// stretch of the triangles (the right stretch tensor U, C = U^2) is averaged over a radius, every
// tensor carried to the vertex over the surface, by area and a Gaussian of the distance. On a mesh
// so fine that many triangles lie within the radius, some stand for all: memory grows with the
// vertices alone.
class CompressionSolver {
 public:
  // `surface` outlives the solver. `radius`: metres, >= 0 (0: the triangles around the vertex).
  // Unfinished where `pace` was stopped.
  CompressionSolver(const Surface& surface, float radius, Pace* pace);

  struct Field {
    // One a welded vertex, in its axes: compression 1 - stretch along principal directions, [0, 1],
    // 0 where the surface is stretched.
    std::vector<Tensor2> tensors;
    std::vector<float> growth;  // likewise: area over that at rest, [0, (1 + limit)^2]
    float worst = 0.0f;         // of any triangle, before averaging
  };
  // `skin_matrices`: one a joint that a vertex names. Compression above `limit` counts as `limit`.
  [[nodiscard]] Field Solve(std::span<const glm::mat4> skin_matrices, float limit) const;

  // Triangles that an average is made of, all vertices together.
  [[nodiscard]] std::size_t num_terms() const { return terms_.size(); }

 private:
  struct Term {
    std::uint32_t triangle;
    float share;  // the shares of a vertex sum to 1
    Turn turn;
  };

  // What the blended motion makes of a vertex: where it goes, and how its surroundings turn.
  struct Posed {
    glm::vec3 position{0.0f};
    glm::mat3 turn{1.0f};
  };
  [[nodiscard]] std::vector<Posed> Pose(std::span<const glm::mat4> skin_matrices) const;
  [[nodiscard]] Tensor2 StretchOf(std::size_t triangle, std::span<const Posed> posed, float limit,
                                  float* worst) const;
  static void Thin(std::vector<Term>* terms);
  void Gather(std::size_t vertex, float radius, SurfaceReach* reach, std::vector<Term>* terms);

  const Surface& surface_;
  std::vector<Term> terms_;
  std::vector<std::size_t> starts_;
};

// Several poses that feed one map, as one field: about the largest compression, direction by
// direction. Poses that press one place along different directions so leave it a second principal
// compression, and folds that cross.
class CompressionSum {
 public:
  explicit CompressionSum(std::size_t vertices) : sums_(vertices) {}
  // `weights`: one a vertex, [0, 1].
  void Add(std::span<const Tensor2> tensors, std::span<const float> weights);
  [[nodiscard]] std::vector<Tensor2> Take() const;

 private:
  std::vector<Tensor2> sums_;  // of fourth powers
};

}  // namespace furrow::character::bake
