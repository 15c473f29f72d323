// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

namespace furrow::authoring {

// The amount of blood in the skin, and the colour that results.
//
// A patch of skin keeps its blood while its area changes. Compressed skin therefore reddens and
// stretched skin pales: measured haemoglobin is linear in the strain of a face (Jimenez et al.
// 2010, A Practical Appearance Model for Dynamic Facial Color; Scully, Measuring and Simulating
// Haemodynamics due to Geometric Changes in Facial Expression, UCL).
//
// Folds add to this. A ridge stretches the upper side of the skin and pales. A furrow presses the
// blood out of its bottom into the skin beside it, which reddens. Thick skin does both more than
// thin skin.

// The skin of a region of the face.
struct SkinSite {
  std::string_view region;  // of a rig, without its side
  float epidermis_mm = 0.2f;
  float dermis_mm = 0.96f;
  float blood = 1.0f;  // near the surface at rest, relative to the mean of the face
};

// Thicknesses: means of 49 men and of 69 women, averaged, at the site that is named behind the
// region (BMC Medical Imaging 22:113, 2022, table 2).
//
// Blood: the order is measured, the amounts are ours. Most: nose and the skin beside it, cheeks;
// least: around the lips (Analysis of Facial Vascular Pattern Characteristics in the Korean
// Population, Skin Research and Technology 2023). More on the cheek than on the forehead (Machkova
// et al., Archives of Dermatological Research 310, 2018: erythema of 442 women). Lids have the
// strongest flow of 17 sites (Fei et al., Skin Research and Technology 24, 2018). The region of the
// mouth reaches from the wing of the nose over the cheek to the chin, so it has the mean.
inline constexpr SkinSite kSkinSites[] = {{"brow", 0.21f, 1.015f, 0.85f},    // forehead
                                          {"glabella", 0.2f, 1.02f, 0.85f},  // glabella
                                          {"nose", 0.195f, 0.98f, 1.2f},     // nasal dorsum
                                          {"eye", 0.175f, 0.625f, 1.1f},     // eyelid
                                          {"mouth", 0.195f, 1.005f, 1.0f}};  // cheekbone
inline constexpr SkinSite kOtherSkin = {""};

// The distance of the uppermost vessels, which lie below the epidermis, from the middle of the
// skin, millimetres. Skin that bends to a curvature k is stretched there by k times this.
[[nodiscard]] constexpr float BendArm(const SkinSite& site) {
  return 0.5f * (site.dermis_mm - site.epidermis_mm);
}

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

// How much a fold stretches the uppermost vessels, as a share of their length, [0, 0.5]; 0 in a
// valley. `arm_mm`: BendArm(). The fold is taken for a sine: its ridge of the height h has the
// curvature h (2 pi / wavelength)^2.
[[nodiscard]] float RidgeStretch(float arm_mm, float height_mm, float wavelength_mm);

// The share of the blood that a furrow presses out, [0, 0.5]. `arm_mm`: BendArm(). `cavity`: how
// open the point is to the sky, 0 closed to 1 open.
[[nodiscard]] float PressedOut(float arm_mm, float cavity);

// The factor by which blood per area `blood` (1 at rest) multiplies the linear colour of the skin,
// per channel, at most kBloodTintScale. It follows from the absorbance of the blood that is added
// to or missing from the amount at rest.
[[nodiscard]] glm::vec3 BloodTint(float blood);

// The factor that a texel of 255 in a colour picture stands for; above 1 so that skin can become
// paler. The value is 1 over the linear value of the sRGB byte 230, so skin at rest keeps its exact
// colour.
inline constexpr float kBloodTintScale = 1.2637465f;

}  // namespace furrow::authoring
