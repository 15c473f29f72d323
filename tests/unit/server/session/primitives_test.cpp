// SPDX-License-Identifier: Apache-2.0
// The small parts of a session: bucket, gate, credit.
#include <random>

#include <gtest/gtest.h>

#include "server/core/token_bucket.h"
#include "server/session/peers/send_credit.h"
#include "server/session/subscriptions/rate_gate.h"

namespace furrow::server {
namespace {

TEST(TokenBucket, LetsABurstThroughThenTheRate) {
  TokenBucket bucket(10.0, 3.0);
  const Time start = FromSeconds(100);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(bucket.Take(start));
  EXPECT_FALSE(bucket.Take(start));
  EXPECT_FALSE(bucket.Take(start + FromSeconds(0.09)));
  EXPECT_TRUE(bucket.Take(start + FromSeconds(0.1001)));
  EXPECT_FALSE(bucket.Take(start + FromSeconds(0.1001)));
}

TEST(TokenBucket, NeverHoldsMoreThanTheBurst) {
  TokenBucket bucket(10.0, 2.0);
  EXPECT_TRUE(bucket.Take(FromSeconds(0)));
  int passed = 0;
  while (bucket.Take(FromSeconds(1000))) ++passed;
  EXPECT_EQ(passed, 2);
}

TEST(TokenBucket, TimeThatRunsBackEarnsNothing) {
  TokenBucket bucket(10.0, 1.0);
  EXPECT_TRUE(bucket.Take(FromSeconds(10)));
  EXPECT_FALSE(bucket.Take(FromSeconds(5)));
  EXPECT_FALSE(bucket.Take(FromSeconds(10.05)));
  EXPECT_TRUE(bucket.Take(FromSeconds(10.11)));
}

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

TEST(RateGate, NeverExceedsTheRateByMoreThanItsGrace) {
  RateGate gate(25.0);
  int passed = 0;
  for (int frame = 0; frame < 1000; ++frame) {
    passed += gate.Pass(FromSeconds(frame / 1000.0)) ? 1 : 0;
  }
  EXPECT_NEAR(passed, 25, 2);
}

TEST(RateGate, APauseEarnsNoBurst) {
  RateGate gate(10.0);
  EXPECT_TRUE(gate.Pass(FromSeconds(0)));
  EXPECT_TRUE(gate.Pass(FromSeconds(60)));
  EXPECT_FALSE(gate.Pass(FromSeconds(60.01)));
  EXPECT_FALSE(gate.Pass(FromSeconds(60.05)));
  EXPECT_TRUE(gate.Pass(FromSeconds(60.1)));
}

TEST(RateGate, AnotherRateCountsFromWhatPassedLast) {
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

TEST(RateGate, TheTiniestRateStillPassesNowAndThen) {
  RateGate gate(1e-30);
  EXPECT_TRUE(gate.Pass(FromSeconds(10)));
  EXPECT_FALSE(gate.Pass(FromSeconds(1000)));
  EXPECT_TRUE(gate.Pass(FromSeconds(10 + 3600)));
}

TEST(SendCredit, UnprovenGetsAtMostWhatItSent) {
  SendCredit credit;
  credit.Received(100);
  EXPECT_TRUE(credit.Spend(60));
  EXPECT_FALSE(credit.Spend(41));
  EXPECT_TRUE(credit.Spend(40));
  EXPECT_FALSE(credit.Spend(1));
  credit.Prove();
  EXPECT_TRUE(credit.Spend(1'000'000));
}

}  // namespace
}  // namespace furrow::server
