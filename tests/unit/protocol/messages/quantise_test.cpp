// SPDX-License-Identifier: Apache-2.0
#include "protocol/messages/quantise.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include "tests/unit/protocol/samples.h"

namespace furrow::protocol {
namespace {

TEST(Quantise, RotationsStayWithinStatedError) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  double worst = 0.0;
  for (int i = 0; i < 200'000; ++i) {
    double v[4] = {normal(random), normal(random), normal(random), normal(random)};
    if (i % 4 == 0) v[0] = v[1] = v[2] = v[3] * (1.0 + 1e-4 * normal(random));  // the worst corner
    const double n = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3]);
    const Quat q{static_cast<float>(v[0] / n), static_cast<float>(v[1] / n),
                 static_cast<float>(v[2] / n), static_cast<float>(v[3] / n)};
    Quat back;
    ASSERT_TRUE(UnpackQuat(PackQuat(q), back));
    EXPECT_NEAR(back.x * back.x + back.y * back.y + back.z * back.z + back.w * back.w, 1.0, 1e-6);
    worst = std::max(worst, test::AngleBetween(q, back));
  }
  std::printf("largest rotation error: %.3g rad of %.3g\n", worst, double{kMaxRotationError});
  EXPECT_LE(worst, kMaxRotationError);
  EXPECT_GE(worst, 0.5 * kMaxRotationError) << "the stated bound is far from tight";
}

TEST(Quantise, IdentityIsExact) {
  for (const Quat& q : {Quat{0, 0, 0, 1}, Quat{1, 0, 0, 0}, Quat{0, 1, 0, 0}, Quat{0, 0, 1, 0}}) {
    Quat back;
    ASSERT_TRUE(UnpackQuat(PackQuat(q), back));
    EXPECT_EQ(back, q);
    ASSERT_TRUE(UnpackQuat(PackQuat({-q.x, -q.y, -q.z, -q.w}), back));
    EXPECT_EQ(back, q) << "the same rotation";
  }
}

TEST(Quantise, RejectsBitsThatAreNotARotation) {
  Quat q;
  const PackedQuat identity = PackQuat({0, 0, 0, 1});
  EXPECT_FALSE(
      UnpackQuat({identity[0], identity[1], static_cast<std::uint16_t>(identity[2] | 0x8000)}, q));
  EXPECT_FALSE(UnpackQuat({0x7FFF, identity[1], identity[2]}, q));
  EXPECT_FALSE(UnpackQuat({0, 0, 0}, q)) << "three times -1/sqrt(2)";
  EXPECT_EQ(q, Quat{});
}

TEST(Quantise, OffsetsAndShapesStayWithinHalfAStep) {
  for (int i = -1000; i <= 1000; ++i) {
    const float value = 0.00173f * static_cast<float>(i);
    EXPECT_NEAR(UnpackOffset(PackOffset(value, 1.73f), 1.73f), value, 1.73f / 65534 * 1.001f);
    EXPECT_NEAR(UnpackBlendShape(PackBlendShape(value)), value, 1.0f / 32768 * 1.001f);
  }
  EXPECT_EQ(UnpackOffset(PackOffset(0.3f, 0.3f), 0.3f), 0.3f);
  EXPECT_EQ(PackOffset(5.0f, 0.0f), 0);
  EXPECT_EQ(PackOffset(9.0f, 3.0f), 32767);
  EXPECT_EQ(UnpackBlendShape(PackBlendShape(1.0f)), 1.0f);
  EXPECT_EQ(PackBlendShape(-7.0f), -32767);
}

TEST(Quantise, WeightsStayWithinHalfAStepAndKeepEnds) {
  for (int i = 0; i <= 1000; ++i) {
    const float value = static_cast<float>(i) / 1000.0f;
    EXPECT_NEAR(UnpackWeight(PackWeight(value)), value, 1.0f / 510 * 1.001f);
  }
  EXPECT_EQ(UnpackWeight(PackWeight(1.0f)), 1.0f);
  EXPECT_EQ(UnpackWeight(PackWeight(0.0f)), 0.0f);
  EXPECT_EQ(PackWeight(1.5f), 255);
  EXPECT_EQ(PackWeight(-0.5f), 0);
}

}  // namespace
}  // namespace furrow::protocol
