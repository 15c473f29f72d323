// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "render/skin/skin_profile.h"

// Taps and tables that the subsurface passes derive from a diffusion profile. No OpenGL here.
namespace furrow::render {

// A tap of a two-dimensional kernel.
struct DiscTap {
  glm::vec2 offset{0.0f};  // mm
  glm::vec3 weight{0.0f};  // sums to 1 over the taps, per channel
};

inline constexpr int kMaxDiscTaps = 64;

// Burley's profile as a spiral of taps, starting at the centre. Radii follow by importance sampling
// of the widest channel, angles by the golden angle. A tap's weight is each channel's share of the
// light in the tap's ring. `d`: parameter of BurleyProfile() per channel, mm. `taps`: clamped to
// [1, kMaxDiscTaps].
[[nodiscard]] std::vector<DiscTap> BurleyDisc(const glm::vec3& d, int taps);

// The diffuse light that leaves a point of a sphere of skin under a distant light of irradiance 1
// at normal incidence. `cosine`: between the normal at the point and the direction to the light.
// `curvature`: 1 / radius in 1/mm, at least 0. The profile is integrated numerically over the
// sphere by chord length and normalised, as Penner and Borshukov (2011) do on a ring.
[[nodiscard]] glm::vec3 SphereResponse(const SkinProfile& profile, double cosine, double curvature);

// SphereResponse() as a table for the method preintegrated: `size` x `size`, columns are cosines
// from -1 to 1, rows are curvatures from 0 to kMaxCurvature, and the outer texel centres are at the
// ends of both ranges.
inline constexpr float kMaxCurvature = 0.5f;  // 1/mm; the rim of a nostril
[[nodiscard]] std::vector<glm::vec3> PreintegratedTable(const SkinProfile& profile, int size);

}  // namespace furrow::render
