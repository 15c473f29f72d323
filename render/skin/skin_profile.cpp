// SPDX-License-Identifier: Apache-2.0
#include "render/skin/skin_profile.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace furrow::render {
namespace {

// Sum over the Gaussians of weight * term(variance).
glm::vec3 WeighedSum(const SkinProfile& profile, const std::function<double(double)>& term) {
  glm::dvec3 sum(0.0);
  for (const SkinGaussian& gaussian : profile) {
    sum += glm::dvec3(gaussian.weight) * term(static_cast<double>(gaussian.variance));
  }
  return glm::vec3(sum);
}

// The minimum in [low, high] of `cost`, which falls and then rises, by golden-section search.
double Minimise(const std::function<double(double)>& cost, double low, double high) {
  const double shrink = 1.0 / std::numbers::phi;
  // Each step keeps 0.62 of the interval; 60 steps leave less than 1e-12 of it.
  for (int step = 0; step < 60; ++step) {
    const double a = high - shrink * (high - low);
    const double b = low + shrink * (high - low);
    if (cost(a) < cost(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return 0.5 * (low + high);
}

// Squared difference of the shares within r, summed over equal steps of log r, because the details
// of a profile are as wide as their distance.
double ShareDistance(const SkinProfile& profile, int channel, double d) {
  double sum = 0.0;
  for (double r = 0.02; r < 12.0; r *= 1.05) {
    const double difference =
        BurleyShare(d, r) - static_cast<double>(RadialShare(profile, r)[channel]);
    sum += difference * difference;
  }
  return sum;
}

}  // namespace

const SkinProfile& HumanSkin() {
  static const SkinProfile profile = {{{0.0064f, {0.233f, 0.455f, 0.649f}},
                                       {0.0484f, {0.100f, 0.336f, 0.344f}},
                                       {0.187f, {0.118f, 0.198f, 0.0f}},
                                       {0.567f, {0.113f, 0.007f, 0.007f}},
                                       {1.99f, {0.358f, 0.004f, 0.0f}},
                                       {7.41f, {0.078f, 0.0f, 0.0f}}}};
  return profile;
}

glm::vec3 RadialProfile(const SkinProfile& profile, double r) {
  return WeighedSum(profile, [r](double v) {
    return std::exp(-r * r / (2.0 * v)) / (2.0 * std::numbers::pi * v);
  });
}

glm::vec3 RadialShare(const SkinProfile& profile, double r) {
  return WeighedSum(profile, [r](double v) { return -std::expm1(-r * r / (2.0 * v)); });
}

glm::vec3 LineProfile(const SkinProfile& profile, double x) {
  return WeighedSum(profile, [x](double v) {
    return std::exp(-x * x / (2.0 * v)) / std::sqrt(2.0 * std::numbers::pi * v);
  });
}

glm::vec3 StepResponse(const SkinProfile& profile, double x) {
  return WeighedSum(profile, [x](double v) { return 0.5 * std::erfc(-x / std::sqrt(2.0 * v)); });
}

glm::vec3 Transmittance(const SkinProfile& profile, double thickness) {
  return WeighedSum(profile,
                    [thickness](double v) { return std::exp(-thickness * thickness / v); });
}

std::array<float, kNumSkinGaussians> CascadedSigmas(const SkinProfile& profile) {
  std::array<float, kNumSkinGaussians> sigmas{};
  float before = 0.0f;
  for (int i = 0; i < kNumSkinGaussians; ++i) {
    const float variance = profile[static_cast<std::size_t>(i)].variance;
    sigmas[static_cast<std::size_t>(i)] = std::sqrt(std::max(variance - before, 0.0f));
    before = variance;
  }
  return sigmas;
}

double BurleyProfile(double d, double r) {
  const double safe = std::max(r, 1e-9);  // the profile is infinite at 0, but its integral is
                                          // finite
  return (std::exp(-safe / d) + std::exp(-safe / (3.0 * d))) / (8.0 * std::numbers::pi * d * safe);
}

double BurleyShare(double d, double r) {
  return 1.0 - 0.25 * std::exp(-r / d) - 0.75 * std::exp(-r / (3.0 * d));
}

double BurleyRadius(double d, double share) {
  // With u = 1 - share and e = exp(-r / 3d): e^3 + 3 e = 4 u, solved by Cardano's formula.
  const double u = 1.0 - std::clamp(share, 0.0, 1.0 - 1e-12);
  const double root = std::cbrt(2.0 * u + std::sqrt(1.0 + 4.0 * u * u));
  const double e = root - 1.0 / root;
  return std::max(-3.0 * d * std::log(e), 0.0);
}

// The search interval, in mm, encloses the standard deviations of the Gaussians (0.08 to 2.7 mm).
glm::vec3 FitBurley(const SkinProfile& profile) {
  glm::vec3 fit;
  for (int channel = 0; channel < 3; ++channel) {
    fit[channel] = static_cast<float>(
        Minimise([&](double d) { return ShareDistance(profile, channel, d); }, 0.005, 3.0));
  }
  return fit;
}

}  // namespace furrow::render
