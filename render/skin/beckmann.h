// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

// The specular reflection of skin by Kelemen and Szirmay-Kalos (2001) with the Beckmann
// distribution, and the look-up tables of the shaders. `m` is Beckmann's root mean square slope. No
// OpenGL here.
namespace furrow::render {

// kPhysical divides by pi, so that no surface reflects more light than it receives. kGems is the
// form printed in GPU Gems 3 (chapter 14) and in the thesis, which is pi times as bright.
enum class SpecularNorm { kPhysical, kGems };

inline constexpr float kSkinF0 = 0.028f;           // Schlick's reflectance of skin at normal
                                                   // incidence
inline constexpr float kMinBeckmannM = 1.0f / 32;  // smallest m; the look-up table saturates below
                                                   // it

// The Beckmann term PH = exp(-tan^2(theta_h) / m^2) / (m^2 cos^4(theta_h)), cos_h = dot(N, H). 0
// for cos_h <= 0. `m` is clamped to at least kMinBeckmannM.
[[nodiscard]] double BeckmannPh(double cos_h, double m);

// Schlick's approximation. `cos` in [0, 1]: cosine between the half vector and either direction.
[[nodiscard]] double SchlickFresnel(double f0, double cos);

// The reflection max(PH F / dot(h, h), 0), where h = L + V is not normalised; without the factors
// N.L and rho_s. Arguments: the cosines of unit L and V with N, and of L with V. 0 if the light or
// the viewer is below the surface.
[[nodiscard]] double KelemenBrdf(double cos_light, double cos_view, double cos_between, double m,
                                 double f0, SpecularNorm norm);

// Look-up table of the Beckmann term: 0.5 PH^0.1 as 16-bit UNORM, `size` x `size`, decoded as (2
// t)^10. Columns are N.H and rows are m, each from 0 at the centre of the first texel to 1 at the
// centre of the last one: u = (x (size - 1) + 0.5) / size. Rows below kMinBeckmannM repeat that
// row.
[[nodiscard]] std::vector<std::uint16_t> BeckmannTable(int size);

// rho_dt(cos, m): the share of light from one direction that is reflected into the hemisphere, for
// rho_s = 1 and kPhysical; kGems gives pi times as much. Light and view directions are
// interchangeable by reciprocity. The result is linear in Schlick's F0: rho_dt = f0 * x + (1 - f0)
// * y.
[[nodiscard]] glm::dvec2 SpecularAlbedo(double cos, double m);

// SpecularAlbedo() as a table of `size` x `size` texels: columns are cos and rows are m, laid out
// as in BeckmannTable().
[[nodiscard]] std::vector<glm::vec2> SpecularAlbedoTable(int size);

// SpecularAlbedo() for both lobes of a highlight: xy for m, and zw for m / 2, at least
// kMinBeckmannM. Interpolated zw equal the interpolated xy of that m.
[[nodiscard]] std::vector<glm::vec4> TwoLobeAlbedoTable(int size);

}  // namespace furrow::render
