// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

// The Kelemen / Szirmay-Kalos (2001) specular reflection of skin with Beckmann's distribution, and
// the tables that shaders look it up in. `m` is Beckmann's root mean square slope. No OpenGL here.
namespace furrow::render {

// `physical` divides by pi, so that no surface sends out more light than it gets; `gems` is the
// form that GPU Gems 3 (chapter 14) and the thesis print, pi times as bright.
enum class SpecularNorm { kPhysical, kGems };

inline constexpr float kSkinF0 = 0.028f;           // Schlick's reflectance of skin face on
inline constexpr float kMinBeckmannM = 1.0f / 32;  // below it the table saturates

// PH = exp(-tan^2(theta_h) / m^2) / (m^2 cos^4(theta_h)), cos_h = dot(N, H); 0 at and below 0.
// `m` is taken to at least kMinBeckmannM.
[[nodiscard]] double BeckmannPh(double cos_h, double m);

// Schlick's approximation; `cos` in [0, 1] between the half vector and either direction.
[[nodiscard]] double SchlickFresnel(double f0, double cos);

// max(PH F / dot(h, h), 0) with h = L + V, not normalised: cosines of unit L and V with N, and of L
// with V. Without N.L and rho_s. 0 where the light or the viewer is below the surface.
[[nodiscard]] double KelemenBrdf(double cos_light, double cos_view, double cos_between, double m,
                                 double f0, SpecularNorm norm);

// The Beckmann look-up: 0.5 PH^0.1 as 16-bit UNORM, `size` x `size`, decoded as (2 t)^10. Column:
// N.H, row: m, each from 0 at the centre of the first texel to 1 at that of the last, so that
// u = (x (size - 1) + 0.5) / size. Rows below kMinBeckmannM repeat it.
[[nodiscard]] std::vector<std::uint16_t> BeckmannTable(int size);

// rho_dt(cos, m), the share of light from one direction that the reflection sends out again over
// the hemisphere (rho_s = 1), equal for light and view directions by reciprocity; in `physical`,
// `gems` is pi times it. Linear in Schlick's F0: rho_dt = f0 * x + (1 - f0) * y.
[[nodiscard]] glm::dvec2 SpecularAlbedo(double cos, double m);

// SpecularAlbedo() as `size` x `size` texels with column cos and row m, laid out as
// BeckmannTable().
[[nodiscard]] std::vector<glm::vec2> SpecularAlbedoTable(int size);

// The same for both lobes of a highlight: xy of m, zw of m / 2, but of kMinBeckmannM at the least.
// Interpolated, zw are what xy are there.
[[nodiscard]] std::vector<glm::vec4> TwoLobeAlbedoTable(int size);

}  // namespace furrow::render
