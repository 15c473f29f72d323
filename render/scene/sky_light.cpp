// SPDX-License-Identifier: Apache-2.0
#include "render/scene/sky_light.h"

#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

namespace furrow::render {
namespace {

constexpr double kPi = glm::pi<double>();

// The basis functions without their constants, in the order of SphericalHarmonics.
std::array<double, 9> Basis(const glm::dvec3& d) {
  return {1.0,
          d.y,
          d.z,
          d.x,
          d.x * d.y,
          d.y * d.z,
          3.0 * d.z * d.z - 1.0,
          d.x * d.z,
          d.x * d.x - d.y * d.y};
}

// The constants that make the basis orthonormal.
std::array<double, 9> Constants() {
  const double band0 = 0.5 * std::sqrt(1.0 / kPi);
  const double band1 = std::sqrt(3.0 / (4.0 * kPi));
  const double band2 = 0.5 * std::sqrt(15.0 / kPi);
  return {band0, band1,      band1, band1, band2, band2, 0.25 * std::sqrt(5.0 / kPi),
          band2, 0.5 * band2};
}

}  // namespace

glm::vec3 SkyRadiance(const GradientSky& sky, const glm::vec3& direction) {
  const glm::vec3& pole = direction.y > 0.0f ? sky.zenith : sky.ground;
  return glm::mix(sky.horizon, pole, direction.y * direction.y);
}

SphericalHarmonics ProjectRadiance(const std::function<glm::vec3(const glm::vec3&)>& radiance) {
  constexpr int kHeights = 64;  // samples at the midpoints of equal areas in y and azimuth
  constexpr int kAzimuths = 64;
  const std::array<double, 9> constants = Constants();
  std::array<glm::dvec3, 9> sums{};
  for (int i = 0; i < kHeights; ++i) {
    // Bands of equal height on a sphere have equal areas (Archimedes), so all samples have the same
    // weight.
    const double y = 2.0 * (i + 0.5) / kHeights - 1.0;
    const double radius = std::sqrt(1.0 - y * y);
    for (int j = 0; j < kAzimuths; ++j) {
      const double azimuth = 2.0 * kPi * (j + 0.5) / kAzimuths;
      const glm::dvec3 direction(radius * std::sin(azimuth), y, radius * std::cos(azimuth));
      const glm::dvec3 light = radiance(glm::vec3(direction));
      const std::array<double, 9> basis = Basis(direction);
      for (std::size_t k = 0; k < basis.size(); ++k) sums[k] += light * basis[k];
    }
  }
  const double area = 4.0 * kPi / (kHeights * kAzimuths);
  SphericalHarmonics harmonics;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    harmonics[k] = glm::vec3(sums[k] * constants[k] * area);
  }
  return harmonics;
}

SphericalHarmonics AmbientPolynomial(const SphericalHarmonics& radiance) {
  const std::array<double, 9> constants = Constants();
  SphericalHarmonics polynomial;
  for (std::size_t k = 0; k < polynomial.size(); ++k) {
    // The bands of the clamped cosine, pi, 2 pi / 3 and pi / 4, divided by pi.
    const double band = k == 0 ? 1.0 : (k < 4 ? 2.0 / 3.0 : 0.25);
    polynomial[k] = radiance[k] * static_cast<float>(band * constants[k]);
  }
  return polynomial;
}

glm::vec3 EvaluateAmbient(const SphericalHarmonics& polynomial, const glm::vec3& normal) {
  const std::array<double, 9> basis = Basis(normal);
  glm::vec3 sum(0.0f);
  for (std::size_t k = 0; k < basis.size(); ++k) {
    sum += polynomial[k] * static_cast<float>(basis[k]);
  }
  return sum;
}

}  // namespace furrow::render
