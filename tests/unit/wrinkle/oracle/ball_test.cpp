// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/oracle/ball.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace furrow::wrinkle {
namespace {

BallShares At(BallMode mode, float degrees, float length = 1.0f) {
  const float psi = glm::radians(degrees);
  return SplitBend(mode, 0.8f, length * std::cos(psi), length * std::sin(psi));
}

void ExpectShares(const BallShares& shares, float front, float back, float left, float right) {
  EXPECT_NEAR(shares.front, front, 1e-5f);
  EXPECT_NEAR(shares.back, back, 1e-5f);
  EXPECT_NEAR(shares.left, left, 1e-5f);
  EXPECT_NEAR(shares.right, right, 1e-5f);
}

TEST(Ball, SmoothGivesTheWorkedValues) {
  ExpectShares(At(BallMode::kSmooth, 0.0f), 0.8f, 0.0f, 0.0f, 0.0f);
  ExpectShares(At(BallMode::kSmooth, 90.0f), 0.0f, 0.0f, 0.0f, 0.8f);
  ExpectShares(At(BallMode::kSmooth, 180.0f), 0.0f, 0.8f, 0.0f, 0.0f);
  ExpectShares(At(BallMode::kSmooth, -90.0f), 0.0f, 0.0f, 0.8f, 0.0f);
  ExpectShares(At(BallMode::kSmooth, 30.0f), 0.6f, 0.0f, 0.0f, 0.2f);  // cos^2 = 3/4
  ExpectShares(At(BallMode::kSmooth, -135.0f), 0.0f, 0.4f, 0.4f, 0.0f);
}

TEST(Ball, SmoothSumsToTheBendInEveryDirection) {
  for (int i = 0; i < 720; ++i) {
    const BallShares shares = At(BallMode::kSmooth, static_cast<float>(i) * 0.5f);
    EXPECT_NEAR(shares.front + shares.back + shares.left + shares.right, 0.8f, 1e-5f);
    for (const float share : {shares.front, shares.back, shares.left, shares.right}) {
      EXPECT_GE(share, 0.0f);
      EXPECT_LE(share, 0.8f + 1e-6f);
    }
  }
}

TEST(Ball, OnlyTheDirectionOfTheProjectionCounts) {
  const BallShares near = At(BallMode::kSmooth, 50.0f, 1e-3f);
  const BallShares far = At(BallMode::kSmooth, 50.0f, 1.0f);
  ExpectShares(near, far.front, far.back, far.left, far.right);
}

TEST(Ball, ZeroProjectionGivesNothing) {
  for (const BallMode mode : {BallMode::kSmooth, BallMode::kThesis}) {
    ExpectShares(SplitBend(mode, 1.0f, 0.0f, 0.0f), 0.0f, 0.0f, 0.0f, 0.0f);
  }
}

// C0: a share changes by at most the bend times the steepest slope of cos^2 (1 per radian). C1: the
// slope changes by at most 2 per radian squared.
TEST(Ball, SmoothIsC1AroundTheBone) {
  const auto front = [](int step) {
    return At(BallMode::kSmooth, static_cast<float>(step) * 0.1f).front;
  };
  float worst = 0.0f;
  float worst_bend = 0.0f;
  for (int i = -1800; i < 1800; ++i) {
    worst = std::max(worst, std::abs(front(i + 1) - front(i)));
    const float wide = 10.0f;  // one degree, so that rounding does not hide the second difference
    const float bend = (front(i + 10) - 2.0f * front(i) + front(i - 10)) / wide;
    worst_bend = std::max(worst_bend, std::abs(bend));
  }
  std::printf("ball: at most %.6f per 0.1 degree\n", worst);
  EXPECT_LE(worst, 0.8f * 0.0017454f * 1.01f);
  EXPECT_LE(worst_bend * 10.0f, 0.8f * 2.0f * 0.0174533f * 0.0174533f * 1.05f);
}

TEST(Ball, ThesisJumpsAt41Point4Degrees) {
  ExpectShares(At(BallMode::kThesis, 41.3f), 0.8f, 0.0f, 0.0f, 0.0f);
  ExpectShares(At(BallMode::kThesis, 41.5f), 0.0f, 0.0f, 0.0f, 0.8f);
  ExpectShares(At(BallMode::kThesis, -41.3f), 0.8f, 0.0f, 0.0f, 0.0f);
  ExpectShares(At(BallMode::kThesis, -41.5f), 0.0f, 0.0f, 0.8f, 0.0f);
  ExpectShares(At(BallMode::kThesis, 138.5f), 0.0f, 0.0f, 0.0f, 0.8f);
  ExpectShares(At(BallMode::kThesis, 138.7f), 0.0f, 0.8f, 0.0f, 0.0f);

  float angle = 0.0f;  // the first angle that is not front, to 0.01 degrees
  while (At(BallMode::kThesis, angle).front > 0.0f) angle += 0.01f;
  EXPECT_NEAR(angle, 41.41f, 0.02f);  // acos(0.75) = 41.4096
}

// The thesis says > 0.75, < -0.75 and "between": at the threshold itself nothing is chosen.
TEST(Ball, ThesisStatesNoCaseAtItsThreshold) {
  // hypot(3, sqrt(7)) = 4, so cos(psi) is 0.75 to the last
  // bit, or the test below would see a share.
  const float side = std::sqrt(7.0f);
  ASSERT_EQ(3.0f / std::hypot(3.0f, side), 0.75f);
  ExpectShares(SplitBend(BallMode::kThesis, 0.8f, 3.0f, side), 0.0f, 0.0f, 0.0f, 0.0f);
  ExpectShares(SplitBend(BallMode::kThesis, 0.8f, -3.0f, side), 0.0f, 0.0f, 0.0f, 0.0f);
}

}  // namespace
}  // namespace furrow::wrinkle
