// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace furrow::authoring {

// How much blood the skin holds, and the colour that results.
//
// A patch of skin keeps its blood while its area changes. Compressed skin therefore reddens and
// stretched skin pales: measured haemoglobin is linear in the strain of a face (Jimenez et al.
// 2010, A Practical Appearance Model for Dynamic Facial Color; Scully, Measuring and Simulating
// Haemodynamics due to Geometric Changes in Facial Expression, UCL). A deep furrow presses the
// blood out of its bottom.

// Combines the poses that feed one map into one field: approximately the largest change of area at
// each vertex, growth or shrinkage.
class BloodSum {
 public:
  explicit BloodSum(std::size_t vertices) : sums_(vertices, 0.0f) {}
  // `growth`: CompressionSolver::Field::growth. `weights`: one per vertex, [0, 1].
  void Add(std::span<const float> growth, std::span<const float> weights);
  // Blood per area, one per vertex; 1 is the value at rest.
  [[nodiscard]] std::vector<float> Take() const;

 private:
  std::vector<float> sums_;  // signed fourth powers of the logarithm of the area
};

// The blood that remains in a furrow. `cavity`: as in BakedMap.
[[nodiscard]] float BloodInFurrow(float blood, float cavity);

// The factor of the skin's colour, linear, at most kBloodTintScale. It follows from the absorbance
// of the blood in excess of, or below, the amount at rest.
[[nodiscard]] glm::vec3 BloodTint(float blood);

// The factor that a full texel of a colour picture stands for; above 1 so that skin can pale. The
// value is 1 over the linear value of the sRGB byte 230, so skin at rest keeps its exact colour.
inline constexpr float kBloodTintScale = 1.2637465f;

}  // namespace furrow::authoring
