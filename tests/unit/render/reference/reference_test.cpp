// SPDX-License-Identifier: Apache-2.0
// Tests of the exact references, by closed forms and plain sums.
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/render/reference/diffusion.h"
#include "tests/unit/render/reference/ray_cast.h"

namespace furrow::render::test {
namespace {

// Skin everywhere, lit where x >= width / 2.
FloatPicture Edge(int width, int height) {
  FloatPicture picture(width, height, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  for (int y = 0; y < height; ++y) {
    for (int x = width / 2; x < width; ++x) picture.At(x, y) = glm::vec4(1.0f);
  }
  return picture;
}

TEST(DiffusionReference, AStepEdgeHasTheProfilesStepResponse) {
  constexpr double kMmPerPixel = 0.1;
  const FloatPicture out = Diffuse(HumanSkin(), Edge(600, 301), kMmPerPixel);
  for (const double x : {-3.0, -1.0, -0.25, 0.25, 1.0, 3.0}) {
    const int pixel = 300 + static_cast<int>(std::lround(x / kMmPerPixel - 0.5));
    const glm::vec3 expected = StepResponse(HumanSkin(), (pixel - 300 + 0.5) * kMmPerPixel);
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(out.At(pixel, 150)[channel], expected[channel], 1e-4) << x;
    }
  }
}

TEST(DiffusionReference, MatchesAPlainSumOfTheRadialProfile) {
  FloatPicture picture(40, 30, glm::vec4(0.1f, 0.2f, 0.3f, 1.0f));
  for (int y = 8; y < 20; ++y) {
    for (int x = 10; x < 22; ++x) picture.At(x, y) = glm::vec4(0.9f, 0.8f, 0.7f, 1.0f);
  }
  for (int y = 0; y < 30; ++y) picture.At(30, y).a = 0.0f;  // a cut through the skin
  const FloatPicture out = Diffuse(HumanSkin(), picture, 0.25);
  for (const auto& [x, y] : {std::pair(9, 14), {16, 14}, {22, 20}, {29, 5}}) {
    const glm::dvec3 sum = DiffuseBySum(HumanSkin(), picture, 0.25, x, y, 9);
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(out.At(x, y)[channel], sum[channel], 1e-2) << x << " " << y << " " << channel;
    }
  }
}

TEST(DiffusionReference, ConstantLightStaysAndNoLightCrossesTheMask) {
  FloatPicture picture(64, 48, glm::vec4(0.5f, 0.5f, 0.5f, 1.0f));
  for (int y = 0; y < 48; ++y) {
    for (int x = 40; x < 64; ++x) picture.At(x, y) = glm::vec4(9.0f, 9.0f, 9.0f, 0.0f);
  }
  const FloatPicture out = Diffuse(HumanSkin(), picture, 0.5);
  for (int x = 0; x < 64; ++x) {
    EXPECT_NEAR(out.At(x, 20).r, x < 40 ? 0.5f : 0.0f, 1e-6f);
  }
}

// A sphere above a plane hides (n . d) (r / |d|)^2 of a point's cosine-weighted sky.
TEST(RayCastReference, OpennessUnderASphereMatchesTheClosedForm) {
  const SphereOnPlane scene{{0.0, 0.12, 0.0}, 0.1};
  const auto within = [](double reach) {
    return [reach](double distance) { return distance <= reach ? 1.0 : 0.0; };
  };
  for (const double x : {0.0, 0.1, 0.3}) {
    const double distance2 = x * x + 0.12 * 0.12;
    const double hidden = 0.12 / std::sqrt(distance2) * 0.01 / distance2;
    EXPECT_NEAR(Openness(scene, {x, 0.0, 0.0}, {0, 1, 0}, within(10.0), 20000), 1.0 - hidden, 5e-3)
        << x;
  }
  // Nothing occludes beyond the radius, and the plane hides half of the sky of the sphere's side.
  EXPECT_EQ(Openness(scene, {0.0, 0.0, 0.0}, {0, 1, 0}, within(0.019), 1000), 1.0);
  EXPECT_NEAR(Openness(scene, {0.1, 0.12, 0.0}, {1, 0, 0}, within(1e9), 20000), 0.5, 5e-3);
}

TEST(RayCastReference, TheShadowFallsAwayFromTheLight) {
  const SphereOnPlane scene{{0.0, 0.1, 0.0}, 0.1};
  const glm::dvec3 light = glm::normalize(glm::dvec3(-1.0, 1.0, 0.0));
  const glm::dvec3 up(0, 1, 0);
  // The centre of the shadow is where the ray through the sphere's centre meets the plane: x = 0.1.
  EXPECT_FALSE(SeesLight(scene, {0.1, 0.0, 0.0}, up, light));
  // The shadow is as wide as the sphere across the light.
  EXPECT_FALSE(SeesLight(scene, {0.1, 0.0, 0.0999}, up, light));
  EXPECT_TRUE(SeesLight(scene, {0.1, 0.0, 0.1001}, up, light));
  EXPECT_TRUE(SeesLight(scene, {-0.1, 0.0, 0.0}, up, light));
  EXPECT_FALSE(SeesLight(scene, {0.1, 0.1, 0.0}, {1, 0, 0}, light));  // faces away
}

}  // namespace
}  // namespace furrow::render::test
