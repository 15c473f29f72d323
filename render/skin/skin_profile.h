// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <glm/vec3.hpp>

// Diffusion profiles: how light that enters skin at a point spreads before it leaves. Lengths are
// in millimetres of the character; colours are linear RGB. No OpenGL here.
namespace furrow::render {

// One isotropic Gaussian G(v, r) = exp(-r^2 / 2v) / (2 pi v), r in mm.
struct SkinGaussian {
  float variance = 1.0f;   // v, mm^2
  glm::vec3 weight{0.0f};  // per channel; a profile's weights sum to 1
};

inline constexpr int kNumSkinGaussians = 6;

// A sum of Gaussians in the order of increasing variance. Every channel sums to 1. HumanSkin() is
// the fit to a multipole model of three-layered skin by d'Eon and Luebke (GPU Gems 3, chapter 14,
// table 14-1).
using SkinProfile = std::array<SkinGaussian, kNumSkinGaussians>;
[[nodiscard]] const SkinProfile& HumanSkin();  // lives until the process ends

// R(r): share of light per mm^2 that leaves at distance `r` (mm) from the point of entry.
[[nodiscard]] glm::vec3 RadialProfile(const SkinProfile& profile, double r);
// Share of light that leaves within distance `r` (mm), in [0, 1).
[[nodiscard]] glm::vec3 RadialShare(const SkinProfile& profile, double r);
// The profile of a line of light, per mm, at distance `x` (mm): R integrated along the line.
[[nodiscard]] glm::vec3 LineProfile(const SkinProfile& profile, double x);
// Light at `x` (mm) from a straight edge, where skin is lit with 1 for x > 0 and dark elsewhere:
// sum_i w_i Phi(x / sigma_i), in [0, 1].
[[nodiscard]] glm::vec3 StepResponse(const SkinProfile& profile, double x);
// Share of light that passes through `thickness` mm of skin: sum_i w_i exp(-s^2 / v_i) (Jimenez
// 2010; GPU Gems 3 divides by 2 v).
[[nodiscard]] glm::vec3 Transmittance(const SkinProfile& profile, double thickness);

// Standard deviations (mm) of consecutive blurs, each of which widens a picture to the next
// Gaussian of the profile: square roots of the differences of the variances, starting from 0.
[[nodiscard]] std::array<float, kNumSkinGaussians> CascadedSigmas(const SkinProfile& profile);

// Burley's normalised diffusion (Christensen and Burley 2015), R(r) = (exp(-r/d) + exp(-r/3d)) / (8
// pi d r); `d` and `r` in mm.
[[nodiscard]] double BurleyProfile(double d, double r);
// Share of light of Burley's profile that leaves within distance `r`: 1 - exp(-r/d)/4 -
// 3 exp(-r/3d)/4, in [0, 1).
[[nodiscard]] double BurleyShare(double d, double r);
// The distance r in mm with BurleyShare(d, r) = `share`, in [0, 1) (Golubev 2018).
[[nodiscard]] double BurleyRadius(double d, double share);
// Fits Burley's profile to `profile`: the `d` in mm of each channel that minimises the squared
// difference of the shares of light within r, over all r.
[[nodiscard]] glm::vec3 FitBurley(const SkinProfile& profile);

}  // namespace furrow::render
