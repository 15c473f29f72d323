// SPDX-License-Identifier: Apache-2.0
#include "server/session/subscriptions/rate_gate.h"

#include <random>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

TEST(RateGate, WithoutARateEverythingPasses) {
  RateGate gate;
  EXPECT_TRUE(gate.Pass(FromSeconds(1)));
  EXPECT_TRUE(gate.Pass(FromSeconds(1)));
}

TEST(RateGate, HalvesAStreamThatJitters) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-0.0012, 0.0012);
  RateGate gate(30.0);
  int passed = 0;
  for (int frame = 0; frame < 600; ++frame) {
    passed += gate.Pass(FromSeconds(1.0 + frame / 60.0 + jitter(random))) ? 1 : 0;
  }
  EXPECT_NEAR(passed, 300, 3);
}

TEST(RateGate, NeverExceedsTheRateByMoreThanItsTolerance) {
  RateGate gate(25.0);
  int passed = 0;
  for (int frame = 0; frame < 1000; ++frame) {
    passed += gate.Pass(FromSeconds(frame / 1000.0)) ? 1 : 0;
  }
  EXPECT_NEAR(passed, 25, 2);
}

TEST(RateGate, APauseAllowsNoBurst) {
  RateGate gate(10.0);
  EXPECT_TRUE(gate.Pass(FromSeconds(0)));
  EXPECT_TRUE(gate.Pass(FromSeconds(60)));
  EXPECT_FALSE(gate.Pass(FromSeconds(60.01)));
  EXPECT_FALSE(gate.Pass(FromSeconds(60.05)));
  EXPECT_TRUE(gate.Pass(FromSeconds(60.1)));
}

TEST(RateGate, ANewRateCountsFromTheLastEvent) {
  RateGate gate(10.0);
  EXPECT_TRUE(gate.Pass(FromSeconds(1)));
  for (int i = 0; i < 5; ++i) {
    gate.SetRate(i % 2 == 0 ? 20.0 : 10.0);
    EXPECT_FALSE(gate.Pass(FromSeconds(1.01)));
  }
  EXPECT_TRUE(gate.Pass(FromSeconds(1.05)));
  gate.SetRate(0.0);
  EXPECT_TRUE(gate.Pass(FromSeconds(1.05)));
}

TEST(RateGate, TheLowestRateIsOnePerHour) {
  RateGate gate(1e-30);
  EXPECT_TRUE(gate.Pass(FromSeconds(10)));
  EXPECT_FALSE(gate.Pass(FromSeconds(1000)));
  EXPECT_TRUE(gate.Pass(FromSeconds(10 + 3600)));
}

}  // namespace
}  // namespace furrow::server
