// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/strain/strain.h"

#include <cmath>
#include <limits>
#include <random>

#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace furrow::wrinkle {
namespace {

const glm::vec3 kA(0.2f, -0.1f, 0.0f);
const glm::vec3 kB(1.4f, 0.3f, 0.0f);
const glm::vec3 kC(0.5f, 0.9f, 0.0f);
const glm::vec3 kX(1.0f, 0.0f, 0.0f);

RestTriangle Rest() { return *MakeRestTriangle(kA, kB, kC, kX); }

template <class Map>
PrincipalStretches Stretched(Map map) {
  return Principal(RightCauchyGreen(Deform(Rest(), map(kA), map(kB), map(kC))));
}

// How far two directions differ, in degrees; a direction and its negative are one.
float AngleBetween(const glm::vec2& a, const glm::vec2& b) {
  return glm::degrees(std::acos(std::min(1.0f, std::abs(glm::dot(a, b)))));
}

glm::vec2 Along(float degrees) {
  return {std::cos(glm::radians(degrees)), std::sin(glm::radians(degrees))};
}

TEST(Strain, RestIsNotStretched) {
  const PrincipalStretches rest = Stretched([](const glm::vec3& p) { return p; });
  EXPECT_NEAR(rest.largest, 1.0f, 1e-6f);
  EXPECT_NEAR(rest.smallest, 1.0f, 1e-6f);
}

TEST(Strain, AxesFollowTheDirectionAndTurnLeft) {
  const RestTriangle rest = Rest();
  EXPECT_NEAR(glm::distance(rest.axes.x, kX), 0.0f, 1e-6f);
  EXPECT_NEAR(glm::distance(rest.axes.y, glm::vec3(0, 1, 0)), 0.0f, 1e-6f);
  EXPECT_NEAR(glm::distance(rest.axes.normal, glm::vec3(0, 0, 1)), 0.0f, 1e-6f);
  EXPECT_NEAR(rest.area, 0.5f * (1.2f * 1.0f - 0.4f * 0.3f), 1e-6f);
  // A direction that leaves the plane counts as far as it lies in it.
  const auto slanted = MakeRestTriangle(kA, kB, kC, glm::vec3(1, 0, 5));
  EXPECT_NEAR(glm::distance(slanted->axes.x, kX), 0.0f, 1e-5f);
  // Along the normal there is none in it: the edge a b.
  const auto upright = MakeRestTriangle(kA, kB, kC, glm::vec3(0, 0, 1));
  EXPECT_NEAR(glm::distance(upright->axes.x, glm::normalize(kB - kA)), 0.0f, 1e-6f);
}

TEST(Strain, StretchAlongAnAxisIsItself) {
  const PrincipalStretches s =
      Stretched([](const glm::vec3& p) { return glm::vec3(0.7f * p.x, 1.2f * p.y, p.z); });
  EXPECT_NEAR(s.smallest, 0.7f, 1e-6f);
  EXPECT_NEAR(s.largest, 1.2f, 1e-6f);
  EXPECT_LT(AngleBetween(s.smallest_direction, Along(0.0f)), 0.05f);
  EXPECT_LT(AngleBetween(s.largest_direction, Along(90.0f)), 0.05f);
}

// Simple shear by g: stretches sqrt(1 + g^2/4) +- g/2, the largest at atan(2/g)/2 from the x axis.
TEST(Strain, SimpleShearIsTheTextbooks) {
  for (const float g : {0.01f, 0.3f, 1.0f, 2.5f}) {
    const PrincipalStretches s =
        Stretched([g](const glm::vec3& p) { return glm::vec3(p.x + g * p.y, p.y, p.z); });
    const float root = std::sqrt(1.0f + 0.25f * g * g);
    EXPECT_NEAR(s.largest, root + 0.5f * g, 1e-5f) << g;
    EXPECT_NEAR(s.smallest, root - 0.5f * g, 1e-5f) << g;
    const float phi = 0.5f * glm::degrees(std::atan2(2.0f, g));
    // F^T F = [1 g; g 1 + g^2]: 2 phi = atan2(2 g, -g^2) = atan2(2, -g).
    EXPECT_LT(AngleBetween(s.largest_direction, Along(90.0f - phi)), 0.1f) << g;
    EXPECT_NEAR(glm::dot(s.largest_direction, s.smallest_direction), 0.0f, 1e-6f);
  }
}

TEST(Strain, RigidMotionsAndMirrorsChangeNothing) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(-2.0f, 2.0f);
  for (int i = 0; i < 200; ++i) {
    glm::mat3 f(1.0f);
    for (int k = 0; k < 6; ++k) f[k / 3][k % 3] += 0.4f * any(random);
    const glm::quat turn = glm::normalize(glm::quat(any(random), any(random), any(random), 1.3f));
    const glm::vec3 shift(any(random), any(random), any(random));
    const PrincipalStretches here = Stretched([&](const glm::vec3& p) { return f * p; });
    const PrincipalStretches there =
        Stretched([&](const glm::vec3& p) { return turn * (f * p) + shift; });
    const PrincipalStretches mirrored =
        Stretched([&](const glm::vec3& p) { return glm::vec3(1, 1, -1) * (f * p); });
    EXPECT_NEAR(here.largest, there.largest, 1e-5f);
    EXPECT_NEAR(here.smallest, there.smallest, 2e-5f);
    EXPECT_NEAR(here.smallest, mirrored.smallest, 1e-6f);
    if (here.largest - here.smallest > 0.05f) {
      EXPECT_LT(AngleBetween(here.smallest_direction, there.smallest_direction), 0.1f);
    }
  }
}

// The tensor, put together again from its principal parts, is itself.
TEST(Strain, PrincipalPartsMakeUpTheTensor) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> any(-1.5f, 1.5f);
  for (int i = 0; i < 200; ++i) {
    const DeformationGradient f{.x = {any(random), any(random), any(random)},
                                .y = {any(random), any(random), any(random)}};
    const CauchyGreen c = RightCauchyGreen(f);
    const PrincipalStretches p = Principal(c);
    const float l = p.largest * p.largest;
    const float s = p.smallest * p.smallest;
    EXPECT_NEAR(l * p.largest_direction.x * p.largest_direction.x +
                    s * p.smallest_direction.x * p.smallest_direction.x,
                c.xx, 1e-5f);
    EXPECT_NEAR(l * p.largest_direction.x * p.largest_direction.y +
                    s * p.smallest_direction.x * p.smallest_direction.y,
                c.xy, 1e-5f);
    // A unit of length along a principal direction is as long as its stretch in the pose.
    const glm::vec2 d = p.smallest_direction;
    EXPECT_NEAR(glm::length(d.x * f.x + d.y * f.y), p.smallest, 2e-3f);
  }
}

TEST(Strain, DirectionsComeBackToSpace) {
  const RestTriangle rest = Rest();
  EXPECT_NEAR(glm::distance(ToRestSpace(rest.axes, {0.6f, 0.8f}), glm::vec3(0.6f, 0.8f, 0.0f)),
              0.0f, 1e-6f);
  const auto turn = [](const glm::vec3& p) { return glm::vec3(0.0f, 0.5f * p.x, p.y); };
  const DeformationGradient f = Deform(rest, turn(kA), turn(kB), turn(kC));
  EXPECT_NEAR(glm::distance(ToPosedSpace(f, {1, 0}), glm::vec3(0, 1, 0)), 0.0f, 1e-6f);
  EXPECT_EQ(ToPosedSpace({.x = {}, .y = {}}, {1, 0}), glm::vec3(0.0f));
}

TEST(Strain, DegenerateRestTrianglesHaveNoStrain) {
  const glm::vec3 o(1, 2, 3);
  EXPECT_FALSE(MakeRestTriangle(o, o, o, kX));
  EXPECT_FALSE(MakeRestTriangle(o, o + kX, o + 2.0f * kX, kX));
  EXPECT_FALSE(MakeRestTriangle(o, o + kX, o + kX * 0.5f + glm::vec3(0, 1e-7f, 0), kX));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(MakeRestTriangle(o, o + kX, glm::vec3(nan), kX));
  const float huge = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(MakeRestTriangle(o, o + kX, glm::vec3(huge), kX));
  // Small is not degenerate: the shape counts.
  const glm::vec3 b = kX * 1e-4f;
  EXPECT_TRUE(MakeRestTriangle({}, b, {0, 1e-4f, 0}, kX));
}

TEST(Strain, ACollapsedPoseIsFullyCompressed) {
  const PrincipalStretches line =
      Stretched([](const glm::vec3& p) { return glm::vec3(p.x, 0, 0); });
  EXPECT_NEAR(line.smallest, 0.0f, 1e-3f);
  EXPECT_NEAR(line.largest, 1.0f, 1e-5f);
  EXPECT_LT(AngleBetween(line.smallest_direction, Along(90.0f)), 0.1f);
  const PrincipalStretches point = Stretched([](const glm::vec3&) { return glm::vec3(1, 1, 1); });
  EXPECT_EQ(point.largest, 0.0f);
  EXPECT_EQ(Principal({.xx = std::numeric_limits<float>::infinity()}).smallest, 1.0f);
}

PrincipalStretches Squeezed(float most, float least, float degrees) {
  return {.largest = 1.0f - least,
          .smallest = 1.0f - most,
          .largest_direction = Along(degrees + 90.0f),
          .smallest_direction = Along(degrees)};
}

void ExpectShares(const CompressionShares& s, float along, float across, float left, float right) {
  EXPECT_NEAR(s.along, along, 1e-5f);
  EXPECT_NEAR(s.across, across, 1e-5f);
  EXPECT_NEAR(s.diagonal_left, left, 1e-5f);
  EXPECT_NEAR(s.diagonal_right, right, 1e-5f);
}

TEST(CompressionShares, GivesTheWorkedValues) {
  ExpectShares(ShareCompression(Squeezed(0.4f, 0, 0)), 0.4f, 0, 0, 0);
  ExpectShares(ShareCompression(Squeezed(0.4f, 0, 90)), 0, 0.4f, 0, 0);
  ExpectShares(ShareCompression(Squeezed(0.4f, 0, 45)), 0, 0, 0.4f, 0);
  ExpectShares(ShareCompression(Squeezed(0.4f, 0, -45)), 0, 0, 0, 0.4f);
  ExpectShares(ShareCompression(Squeezed(0.4f, 0, 180)), 0.4f, 0, 0, 0);
  ExpectShares(ShareCompression(Squeezed(0.4f, 0, 15)), 0.3f, 0, 0.1f, 0);  // cos^2 30 = 3/4
  ExpectShares(ShareCompression(Squeezed(0.4f, 0.4f, 70)), 0.1f, 0.1f, 0.1f, 0.1f);
  ExpectShares(ShareCompression(Squeezed(0.4f, 0.2f, 0)), 0.25f, 0.05f, 0.05f, 0.05f);
  ExpectShares(ShareCompression(Squeezed(-0.3f, -0.5f, 0)), 0, 0, 0, 0);  // stretched both ways
}

TEST(CompressionShares, SumToTheCompressionAndAreC1InTheDirection) {
  constexpr float kStep = 0.25f;
  CompressionShares before[2] = {ShareCompression(Squeezed(0.5f, 0.1f, -2 * kStep)),
                                 ShareCompression(Squeezed(0.5f, 0.1f, -kStep))};
  for (float degrees = 0.0f; degrees <= 180.0f; degrees += kStep) {
    const CompressionShares s = ShareCompression(Squeezed(0.5f, 0.1f, degrees));
    EXPECT_NEAR(s.along + s.across + s.diagonal_left + s.diagonal_right, 0.5f, 1e-5f);
    EXPECT_NEAR(s.compression, 0.5f, 1e-6f);
    // Steepest slope of (c1 - c2) cos^2 2 phi: 0.8 a radian; steepest curvature 3.2.
    const float radians = glm::radians(kStep);
    EXPECT_LT(std::abs(s.along - before[1].along), 0.81f * radians);
    EXPECT_LT(std::abs(s.along - 2 * before[1].along + before[0].along),
              3.3f * radians * radians + 1e-6f);
    before[0] = before[1];
    before[1] = s;
  }
}

}  // namespace
}  // namespace furrow::wrinkle
