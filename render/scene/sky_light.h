// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>

#include <glm/vec3.hpp>

// Ambient light as nine spherical harmonics per channel (Ramamoorthi and Hanrahan 2001). For skies
// as smooth as these, the error is within 1% of the integral over the hemisphere. Y is up; colours
// are linear. No OpenGL here.
namespace furrow::render {

// Radiance from straight above, from the horizon and from straight below. Between them, for a
// direction of height y: mix(horizon, y > 0 ? zenith : ground, y^2).
struct GradientSky {
  glm::vec3 zenith{0.0f};
  glm::vec3 horizon{0.0f};
  glm::vec3 ground{0.0f};
};

// The radiance from a unit direction.
[[nodiscard]] glm::vec3 SkyRadiance(const GradientSky& sky, const glm::vec3& direction);

// Nine coefficients, in the order of the basis functions 1; y, z, x; xy, yz, 3 z^2 - 1, xz,
// x^2 - y^2.
using SphericalHarmonics = std::array<glm::vec3, 9>;

// The first nine coefficients of a function of direction (unit), by numerical integration.
[[nodiscard]] SphericalHarmonics ProjectRadiance(
    const std::function<glm::vec3(const glm::vec3&)>& radiance);

// The radiance that a white Lambertian surface reflects, as a polynomial of its unit normal
// (x, y, z): c0 + c1 y + c2 z + c3 x + c4 xy + c5 yz + c6 (3 z^2 - 1) + c7 xz + c8 (x^2 - y^2).
// It is `radiance` convolved with max(cosine, 0) / pi. The coefficients c include the constant
// factors of the basis functions; those of ProjectRadiance() do not.
[[nodiscard]] SphericalHarmonics AmbientPolynomial(const SphericalHarmonics& radiance);

// Evaluates the polynomial for a unit `normal`.
[[nodiscard]] glm::vec3 EvaluateAmbient(const SphericalHarmonics& polynomial,
                                        const glm::vec3& normal);

}  // namespace furrow::render
