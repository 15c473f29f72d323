// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "render/skin/skin_profile.h"

// What the subsurface passes make of a diffusion profile: taps and tables. No OpenGL here.
namespace furrow::render {

// A tap of a two-dimensional kernel.
struct DiscTap {
  glm::vec2 offset{0.0f};  // mm
  glm::vec3 weight{0.0f};  // sums to 1 over the taps, per channel
};

inline constexpr int kMaxDiscTaps = 64;

// Burley's profile as a spiral of taps, the first at the centre: radii by importance of the widest
// channel, turned by the golden angle; each tap weighs what its ring holds of each channel. `taps`
// in [1, kMaxDiscTaps], else taken to the nearest.
[[nodiscard]] std::vector<DiscTap> BurleyDisc(const glm::vec3& d, int taps);

// Light that leaves a sphere of curvature `curvature` (1/radius, 1/mm, at least 0) where the
// surface's normal and the direction of a distant light enclose the cosine `cosine`; the light's
// irradiance at normal incidence is 1. Exact but for quadrature: the profile is integrated over the
// sphere by chord length and normalised, as Penner and Borshukov (2011) do on a ring.
[[nodiscard]] glm::vec3 SphereResponse(const SkinProfile& profile, double cosine, double curvature);

// SphereResponse() for the method `preintegrated`: `size` x `size`, texel centres on the ends of
// both ranges: column = cosine from -1 to 1, row = curvature from 0 to kMaxCurvature.
inline constexpr float kMaxCurvature = 0.5f;  // 1/mm: a nostril's rim
[[nodiscard]] std::vector<glm::vec3> PreintegratedTable(const SkinProfile& profile, int size);

}  // namespace furrow::render
