// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/oracle/hinge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace furrow::wrinkle {
namespace {

float Cosine(float degrees) { return std::cos(glm::radians(degrees)); }

// The lower bone after `degrees` about +x, away from an upper bone that hangs down.
glm::vec3 Lower(float degrees) {
  const float a = glm::radians(degrees);
  return {0.0f, -std::cos(a), -std::sin(a)};
}

const glm::vec3 kUpper(0.0f, -1.0f, 0.0f);
const glm::vec3 kAxis(1.0f, 0.0f, 0.0f);

TEST(Hinge, GivesTheWorkedValues) {
  const float scale = BendScale(30.0f);
  EXPECT_NEAR(Bend(Cosine(90.0f), scale), 0.536f, 5e-4f);
  EXPECT_NEAR(Bend(Cosine(45.0f), scale), 0.157f, 5e-4f);
  EXPECT_EQ(Bend(1.0f, scale), 0.0f);
  EXPECT_NEAR(Bend(Cosine(150.0f), scale), 1.0f, 1e-6f);
}

TEST(Hinge, ReachesOneAtFullFlexionForAnyBeta) {
  for (float beta = 0.0f; beta <= 179.0f; beta += 1.0f) {
    EXPECT_NEAR(Bend(Cosine(180.0f - beta), BendScale(beta)), 1.0f, 1e-3f) << beta;
    EXPECT_EQ(Bend(1.0f, BendScale(beta)), 0.0f) << beta;
  }
}

TEST(Hinge, StaysInRangePastFullFlexion) {
  EXPECT_EQ(Bend(Cosine(179.0f), BendScale(60.0f)), 1.0f);
  EXPECT_EQ(Bend(1.0001f, BendScale(60.0f)), 0.0f);  // a cosine past 1 by rounding
}

TEST(Hinge, GuardsBetaAt180) {
  EXPECT_EQ(BendScale(180.0f), 0.0f);
  for (const float cosine : {-1.0f, 0.0f, 1.0f}) EXPECT_EQ(Bend(cosine, BendScale(180.0f)), 0.0f);
}

TEST(Hinge, SignedEqualsUnsignedInFlexionAndIsZeroInHyperextension) {
  const float scale = BendScale(30.0f);
  for (float degrees = 1.0f; degrees < 180.0f; degrees += 1.0f) {
    EXPECT_NEAR(SignedBend(kUpper, Lower(degrees), kAxis, scale), Bend(Cosine(degrees), scale),
                1e-5f);
    EXPECT_EQ(SignedBend(kUpper, Lower(-degrees), kAxis, scale), 0.0f) << degrees;
  }
  EXPECT_EQ(SignedBend(kUpper, kUpper, kAxis, scale), 0.0f);
}

TEST(Hinge, SidewaysBendingFadesOut) {
  const float scale = BendScale(30.0f);
  const auto bent_about = [&](float off_axis) {  // 60 degrees about an axis that far off
    const float a = glm::radians(off_axis);
    const glm::vec3 axis(std::cos(a), 0.0f, std::sin(a));
    const glm::vec3 lower =
        Cosine(60.0f) * kUpper + std::sin(glm::radians(60.0f)) * glm::cross(axis, kUpper);
    return SignedBend(kUpper, lower, kAxis, scale);
  };
  const float whole = Bend(Cosine(60.0f), scale);
  EXPECT_NEAR(bent_about(0.0f), whole, 1e-5f);
  EXPECT_NEAR(bent_about(59.0f), whole, 1e-5f);
  EXPECT_NEAR(bent_about(90.0f), 0.0f, 1e-5f);
  EXPECT_NEAR(bent_about(120.0f), 0.0f, 1e-6f);
  // cos = 0.25 lies half way up smoothstep(0, 0.5).
  EXPECT_NEAR(bent_about(75.522488f), 0.5f * whole, 1e-4f);
}

TEST(Hinge, SweepIsContinuous) {
  const float scale = BendScale(30.0f);
  float worst = 0.0f;
  for (int i = -1790; i < 1790; ++i) {
    const float a = SignedBend(kUpper, Lower(static_cast<float>(i) * 0.1f), kAxis, scale);
    const float b = SignedBend(kUpper, Lower(static_cast<float>(i + 1) * 0.1f), kAxis, scale);
    worst = std::max(worst, std::abs(b - a));
  }
  std::printf("hinge: at most %.6f per 0.1 degree\n", worst);
  // The slope of 4.6 is sin(angle) / (1 + cos(beta)), largest at a right angle: 0.000935 per step.
  EXPECT_LE(worst, 0.00094f);
}

// Around the bone at a fixed bend: the sign does not switch abruptly.
TEST(Hinge, SweepAroundTheBoneIsContinuous) {
  const float scale = BendScale(30.0f);
  const auto at = [&](int step) {
    const float psi = glm::radians(static_cast<float>(step) * 0.1f);
    const glm::vec3 lower(std::sin(psi), 0.0f, std::cos(psi));  // 90 degrees from the upper bone
    return SignedBend(kUpper, lower, kAxis, scale);
  };
  float worst = 0.0f;
  for (int i = 0; i < 3600; ++i) worst = std::max(worst, std::abs(at(i + 1) - at(i)));
  std::printf("hinge, around: at most %.6f per 0.1 degree\n", worst);
  // smoothstep's steepest slope is 1.5 / 0.5 = 3 per unit of cosine: 3 * 0.536 * 0.001745 = 0.0028.
  EXPECT_LE(worst, 0.0029f);
}

}  // namespace
}  // namespace furrow::wrinkle
