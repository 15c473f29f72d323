// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

// The specular reflection of skin by Kelemen and Szirmay-Kalos (2001) with the Beckmann
// distribution, and the look-up tables of the shaders. `m` is the roughness: Beckmann's root mean
// square slope. N is the surface normal, L the direction to the light, V the direction to the
// viewer, H the unit half vector between L and V; all are unit. No OpenGL here.
namespace furrow::render {

// kPhysical divides by pi, so that no surface reflects more light than it receives. kGems is the
// form printed in GPU Gems 3 (chapter 14) and in the thesis, which is pi times as bright.
enum class SpecularNorm { kPhysical, kGems };

inline constexpr float kSkinF0 = 0.028f;           // Schlick's reflectance of skin at normal
                                                   // incidence
inline constexpr float kMinBeckmannM = 1.0f / 32;  // smallest m; the look-up table saturates below
                                                   // it

// The Beckmann term PH = exp(-tan^2(theta) / m^2) / (m^2 cos^4(theta)), with cos(theta) = `cos_h` =
// dot(N, H). 0 for cos_h <= 0. `m` is clamped to at least kMinBeckmannM.
[[nodiscard]] double BeckmannPh(double cos_h, double m);

// The share of light that a surface reflects, by Schlick's approximation: f0 + (1 - f0) (1 -
// cos)^5. `f0`: the share at normal incidence. `cos` in [0, 1]: dot(H, L), which equals dot(H, V).
[[nodiscard]] double SchlickFresnel(double f0, double cos);

// The reflection PH F / dot(h, h), divided by pi for kPhysical, with h = L + V (not normalised) and
// F = SchlickFresnel(). The caller multiplies by dot(N, L) and by the strength rho_s. `cos_light` =
// dot(N, L), `cos_view` = dot(N, V), `cos_between` = dot(L, V). 0 if the light or the viewer is
// below the surface.
[[nodiscard]] double KelemenBrdf(double cos_light, double cos_view, double cos_between, double m,
                                 double f0, SpecularNorm norm);

// Look-up table of the Beckmann term: `size` x `size` texels t = 0.5 PH^0.1 as 16-bit UNORM,
// decoded as PH = (2 t)^10. Columns are dot(N, H) and rows are m, each from 0 at the centre of the
// first texel to 1 at the centre of the last one: the texture coordinate of a value x is (x (size -
// 1) + 0.5) / size. Rows with m below kMinBeckmannM hold the values of kMinBeckmannM.
[[nodiscard]] std::vector<std::uint16_t> BeckmannTable(int size);

// Returns x and y of the share of light from one direction that is reflected into the hemisphere:
// f0 * x + (1 - f0) * y for any reflectance f0 at normal incidence, rho_s = 1 and kPhysical (kGems:
// pi times as much). `cos`: dot(N, L), or dot(N, V), since the reflection is reciprocal.
[[nodiscard]] glm::dvec2 SpecularAlbedo(double cos, double m);

// SpecularAlbedo() as a table of `size` x `size` texels: columns are cos and rows are m, laid out
// as in BeckmannTable().
[[nodiscard]] std::vector<glm::vec2> SpecularAlbedoTable(int size);

// SpecularAlbedo() of both lobes of a highlight as a table of `size` x `size` texels, laid out as
// in BeckmannTable(): xy for m, and zw for max(m / 2, kMinBeckmannM). Interpolated between texels,
// zw equal the interpolated xy of that roughness.
[[nodiscard]] std::vector<glm::vec4> TwoLobeAlbedoTable(int size);

}  // namespace furrow::render
