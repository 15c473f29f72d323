// SPDX-License-Identifier: Apache-2.0
#include "render/scene/sky_light.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace furrow::render {
namespace {

constexpr double kPi = 3.14159265358979323846;

// What a white Lambertian surface sends back, by quadrature over the whole sphere.
glm::dvec3 Integral(const GradientSky& sky, const glm::vec3& normal) {
  constexpr int kSteps = 400;
  glm::dvec3 sum(0.0);
  for (int i = 0; i < kSteps; ++i) {
    const double y = 2.0 * (i + 0.5) / kSteps - 1.0;
    const double radius = std::sqrt(1.0 - y * y);
    for (int j = 0; j < kSteps; ++j) {
      const double azimuth = 2.0 * kPi * (j + 0.5) / kSteps;
      const glm::vec3 direction(radius * std::cos(azimuth), y, radius * std::sin(azimuth));
      const double cosine = std::max(0.0f, glm::dot(direction, normal));
      sum += glm::dvec3(SkyRadiance(sky, direction)) * cosine;
    }
  }
  return sum * 4.0 / (static_cast<double>(kSteps) * kSteps);  // 4 pi / pi
}

SphericalHarmonics AmbientOf(const GradientSky& sky) {
  return AmbientPolynomial(
      ProjectRadiance([&](const glm::vec3& direction) { return SkyRadiance(sky, direction); }));
}

TEST(SkyLight, HasItsColoursAtZenithHorizonAndGround) {
  const GradientSky sky{{1.0f, 2.0f, 3.0f}, {0.5f, 0.4f, 0.3f}, {0.1f, 0.2f, 0.0f}};
  EXPECT_EQ(SkyRadiance(sky, {0.0f, 1.0f, 0.0f}), sky.zenith);
  EXPECT_EQ(SkyRadiance(sky, {1.0f, 0.0f, 0.0f}), sky.horizon);
  EXPECT_EQ(SkyRadiance(sky, {0.0f, -1.0f, 0.0f}), sky.ground);
}

TEST(SkyLight, AUniformSkyLightsAllNormalsEqually) {
  const GradientSky even{glm::vec3(0.7f), glm::vec3(0.7f), glm::vec3(0.7f)};
  const SphericalHarmonics ambient = AmbientOf(even);
  for (const glm::vec3& normal : {glm::vec3(0, 1, 0), glm::vec3(0.6f, -0.8f, 0), {0, 0, -1}}) {
    EXPECT_NEAR(EvaluateAmbient(ambient, normal).g, 0.7f, 1e-3f);
  }
}

TEST(SkyLight, NineCoefficientsAreWithinOnePercentOfTheIntegral) {
  const GradientSky sky{{0.6f, 0.8f, 1.2f}, {0.5f, 0.5f, 0.5f}, {0.2f, 0.15f, 0.1f}};
  const SphericalHarmonics ambient = AmbientOf(sky);
  for (int i = 0; i < 40; ++i) {
    const float y = 2.0f * (static_cast<float>(i) + 0.5f) / 40.0f - 1.0f;
    const float angle = 2.4f * static_cast<float>(i);
    const float radius = std::sqrt(1.0f - y * y);
    const glm::vec3 normal(radius * std::cos(angle), y, radius * std::sin(angle));
    const glm::dvec3 exact = Integral(sky, normal);
    const glm::vec3 ours = EvaluateAmbient(ambient, normal);
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(ours[channel], exact[channel], 0.01 * exact[channel]) << i << " " << channel;
    }
  }
}

// A sky that is brighter on one side: the bands of x and z, too.
TEST(SkyLight, ProjectsSkiesThatVaryInAllDirections) {
  const auto radiance = [](const glm::vec3& d) {
    return glm::vec3(1.0f + 0.5f * d.x, 1.0f - 0.5f * d.z, 1.0f + d.x * d.z);
  };
  const SphericalHarmonics ambient = AmbientPolynomial(ProjectRadiance(radiance));
  const glm::vec3 normal = glm::normalize(glm::vec3(1.0f, 0.5f, -2.0f));
  const glm::vec3 value = EvaluateAmbient(ambient, normal);
  EXPECT_NEAR(value.r, 1.0f + 0.5f * normal.x * 2.0f / 3.0f, 1e-3f);
  EXPECT_NEAR(value.g, 1.0f - 0.5f * normal.z * 2.0f / 3.0f, 1e-3f);
  EXPECT_NEAR(value.b, 1.0f + 0.25f * normal.x * normal.z, 1e-3f);
}

}  // namespace
}  // namespace furrow::render
