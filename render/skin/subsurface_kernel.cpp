// SPDX-License-Identifier: Apache-2.0
#include "render/skin/subsurface_kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace furrow::render {
namespace {

// 2 pi times the mean of max(0, cosine between normal and light) over the ring of points at the
// angle phi from the normal.
double RingIrradiance(double cos_theta, double sin_theta, double phi) {
  const double a = cos_theta * std::cos(phi);
  const double b = sin_theta * std::sin(phi);
  if (a >= b) return 2.0 * std::numbers::pi * a;
  if (a <= -b) return 0.0;
  const double terminator = std::acos(-a / b);
  return 2.0 * (a * terminator + b * std::sin(terminator));
}

// SphereResponse() of one Gaussian on a sphere of `radius` mm: x is the response before
// normalisation, y the normalisation. Midpoint rule over the chord length, on which the profile
// depends.
glm::dvec2 SphereIntegral(double variance, double cos_theta, double radius) {
  constexpr int kSteps = 96;
  const double sin_theta = std::sqrt(std::max(0.0, 1.0 - cos_theta * cos_theta));
  // No chord is longer than the diameter, and a Gaussian is negligible beyond six standard
  // deviations.
  const double reach = std::min(2.0 * radius, 6.0 * std::sqrt(variance));
  glm::dvec2 sum(0.0);
  for (int step = 0; step < kSteps; ++step) {
    const double chord = reach * (step + 0.5) / kSteps;
    const double phi = 2.0 * std::asin(0.5 * chord / radius);
    // The area of a spherical zone is 2 pi c dc with the chord c, as in the plane.
    const double weight = chord * std::exp(-chord * chord / (2.0 * variance));
    sum += weight * glm::dvec2(RingIrradiance(cos_theta, sin_theta, phi), 2.0 * std::numbers::pi);
  }
  return sum * (reach / kSteps) / (2.0 * std::numbers::pi * variance);
}

}  // namespace

std::vector<DiscTap> BurleyDisc(const glm::vec3& d, int taps) {
  const int count = std::clamp(taps, 1, kMaxDiscTaps);
  const double widest = std::max({d.r, d.g, d.b});
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  const auto ring = [&](int i) {  // share inside the inner border of tap i, per channel
    if (i >= count) return glm::vec3(1.0f);
    const double r = BurleyRadius(widest, static_cast<double>(i) / count);
    return glm::vec3(BurleyShare(d.r, r), BurleyShare(d.g, r), BurleyShare(d.b, r));
  };
  std::vector<DiscTap> disc;
  for (int i = 0; i < count; ++i) {
    const double r = i == 0 ? 0.0 : BurleyRadius(widest, (i + 0.5) / count);
    const double angle = golden_angle * i;
    disc.push_back({glm::vec2(r * std::cos(angle), r * std::sin(angle)), ring(i + 1) - ring(i)});
  }
  return disc;
}

glm::vec3 SphereResponse(const SkinProfile& profile, double cosine, double curvature) {
  const double cos_theta = std::clamp(cosine, -1.0, 1.0);
  const double radius = 1.0 / std::max(curvature, 1e-5);  // 100 m is practically flat
  glm::dvec3 light(0.0);
  glm::dvec3 whole(0.0);
  for (const SkinGaussian& gaussian : profile) {
    const glm::dvec2 integral = SphereIntegral(gaussian.variance, cos_theta, radius);
    light += glm::dvec3(gaussian.weight) * integral.x;
    whole += glm::dvec3(gaussian.weight) * integral.y;
  }
  return glm::vec3(light / whole);
}

std::vector<glm::vec3> PreintegratedTable(const SkinProfile& profile, int size) {
  std::vector<glm::vec3> table;
  table.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (int row = 0; row < size; ++row) {
    const double curvature = static_cast<double>(kMaxCurvature) * row / (size - 1);
    for (int column = 0; column < size; ++column) {
      table.push_back(SphereResponse(profile, 2.0 * column / (size - 1) - 1.0, curvature));
    }
  }
  return table;
}

}  // namespace furrow::render
