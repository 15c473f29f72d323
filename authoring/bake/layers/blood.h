// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace furrow::character::bake {

// How much blood skin holds, and what colour that gives it.
//
// A patch of skin keeps its blood while it changes its area, so what a pose squashes reddens and
// what it stretches pales: measured haemoglobin goes linearly with the strain of a face (Jimenez et
// al. 2010, A Practical Appearance Model for Dynamic Facial Color; Scully, Measuring and Simulating
// Haemodynamics due to Geometric Changes in Facial Expression, UCL). A deep furrow presses it out
// of its bottom.

// Several poses that feed one map, as one field: about the largest change of area, be it more or
// less.
class BloodSum {
 public:
  explicit BloodSum(std::size_t vertices) : sums_(vertices, 0.0f) {}
  // `growth`: CompressionSolver::Field's. `weights`: one a vertex, [0, 1].
  void Add(std::span<const float> growth, std::span<const float> weights);
  // Blood for the area, one a vertex; 1 as at rest.
  [[nodiscard]] std::vector<float> Take() const;

 private:
  std::vector<float> sums_;  // of fourth powers of the logarithm, signed
};

// What a furrow leaves of it. `cavity`: BakedMap's.
[[nodiscard]] float BloodInFurrow(float blood, float cavity);

// The factor of skin's colour, linear, at most kBloodTintScale: the absorbance of what there is
// more of or less of. Blood absorbs green and blue.
[[nodiscard]] glm::vec3 BloodTint(float blood);

// What a full texel of a colour picture stands for, so that skin can pale too: 1 over the linear
// value of the sRGB byte 230, so that skin at rest keeps its colour to the bit.
inline constexpr float kBloodTintScale = 1.2637465f;

}  // namespace furrow::character::bake
