// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "authoring/bake/layers/kernels.h"
#include "authoring/bake/pace.h"

namespace furrow::character::bake {

// Makes the waves of neighbouring kernels meet: phases grow from the strongest folds outwards, each
// kernel as its neighbours foretell it, and are then relaxed. Where lengths do not work out, folds
// branch or end. (Phasor noise, Tricard et al. 2019, with the aim of Knoeppel et al.'s stripe
// patterns, 2015: neighbours that agree.)
//
// - Directions are lines: a neighbour that points the other way counts with its phase turned round.
// - Deterministic: the order is that of the kernels.
class PhaseSolver {
 public:
  PhaseSolver(const Surface& surface, KernelSet* set);

  // Unfinished where `pace` was stopped.
  void Align(Pace* pace);

  // Makes folds of uneven depth and length: amplitudes are scaled by noise that is long along folds
  // and narrow across them, within 1 - 2 * `variation` and 1 + 2 * `variation`.
  void VaryDepth(float variation, std::uint32_t seed);

 private:
  struct Neighbour {
    std::uint32_t kernel;
    float share;
    float turn;   // +1, or -1 where the directions oppose
    float shift;  // phase here = turn * phase there + shift
  };
  [[nodiscard]] std::span<const Neighbour> Of(std::size_t kernel) const {
    return std::span(neighbours_).subspan(starts_[kernel], starts_[kernel + 1] - starts_[kernel]);
  }
  // What the neighbours that `known` lists say; false when there are none.
  bool Foretell(std::size_t kernel, const std::vector<char>& known, float* phase) const;
  void Grow();

  KernelSet& set_;
  std::vector<Neighbour> neighbours_;
  std::vector<std::size_t> starts_;
};

}  // namespace furrow::character::bake
