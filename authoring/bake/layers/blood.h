// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace furrow::authoring {

// The amount of blood in the skin, and the colour that results.
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
  // Adds a pose. `growth`: area relative to rest, one per vertex, > 0. `weights`: one per vertex,
  // [0, 1]; 0 ignores the pose there.
  void Add(std::span<const float> growth, std::span<const float> weights);
  // Returns the blood per area, one per vertex: 1 at rest, more where the skin is compressed, less
  // where it is stretched.
  [[nodiscard]] std::vector<float> Take() const;

 private:
  std::vector<float> sums_;  // signed fourth powers of the logarithm of the area
};

// The blood per area that remains in a furrow (1 at rest). `blood`: blood per area without the
// furrow. `cavity`: how open the point is to the sky, 0 closed to 1 open.
[[nodiscard]] float BloodInFurrow(float blood, float cavity);

// The factor by which blood per area `blood` (1 at rest) multiplies the linear colour of the skin,
// per channel, at most kBloodTintScale. It follows from the absorbance of the blood that is added
// to or missing from the amount at rest.
[[nodiscard]] glm::vec3 BloodTint(float blood);

// The factor that a texel of 255 in a colour picture stands for; above 1 so that skin can become
// paler. The value is 1 over the linear value of the sRGB byte 230, so skin at rest keeps its exact
// colour.
inline constexpr float kBloodTintScale = 1.2637465f;

}  // namespace furrow::authoring
