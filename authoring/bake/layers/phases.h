// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "authoring/bake/layers/kernels.h"
#include "authoring/bake/request/bake_progress.h"

namespace furrow::authoring {

// Aligns the waves of neighbouring kernels, so that they form continuous folds. Phases propagate
// outward from the strongest folds: each kernel takes the phase that its already solved neighbours
// predict. Then all phases are relaxed.
// Where neighbouring waves cannot be aligned, folds branch or end. Sources: phasor noise (Tricard
// et al. 2019) and stripe patterns (Knoeppel et al. 2015).
//
// - Directions have no sign: the phase of a neighbour with the opposite direction is negated.
// - Deterministic: ties are broken by the order of the kernels.
class PhaseSolver {
 public:
  // `set` must outlive the solver, which changes the kernels in it.
  PhaseSolver(const Surface& surface, KernelSet* set);

  // Stops early if `progress` is cancelled.
  void Align(BakeProgress* progress);

  // Varies the depth and length of folds: multiplies each amplitude by a factor between
  // 1 - 2 * `variation` and 1 + 2 * `variation`. The factors are noise, stretched along the folds.
  void VaryDepth(float variation, std::uint32_t seed);

 private:
  struct Neighbour {
    std::uint32_t kernel;
    float share;
    float turn;   // +1, or -1 if the directions are opposite
    float shift;  // phase here = turn * phase there + shift
  };
  [[nodiscard]] std::span<const Neighbour> Of(std::size_t kernel) const {
    return std::span(neighbours_).subspan(starts_[kernel], starts_[kernel + 1] - starts_[kernel]);
  }
  // Predicts a phase from the neighbours that are marked in `known`. Returns false if there are
  // none.
  bool PredictPhase(std::size_t kernel, const std::vector<char>& known, float* phase) const;
  void Grow();

  KernelSet& set_;
  std::vector<Neighbour> neighbours_;
  std::vector<std::size_t> starts_;
};

}  // namespace furrow::authoring
