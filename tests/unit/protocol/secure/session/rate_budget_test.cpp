// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/session/rate_budget.h"

#include <gtest/gtest.h>

namespace furrow::protocol::secure {
namespace {

int Taken(RateBudget& budget, std::int64_t now_us, int tries = 1'000) {
  int taken = 0;
  for (int i = 0; i < tries; ++i) taken += budget.Take(now_us);
  return taken;
}

TEST(RateBudget, AllowsOneSecondsWorthAtOnce) {
  RateBudget budget(10);
  EXPECT_EQ(Taken(budget, 5'000'000), 10);
  EXPECT_EQ(Taken(budget, 5'099'999), 0);
  EXPECT_EQ(Taken(budget, 5'100'000), 1);
  EXPECT_EQ(Taken(budget, 5'600'000), 5);
  EXPECT_EQ(Taken(budget, 90'000'000), 10);
}

TEST(RateBudget, ATimeInThePastGivesNothing) {
  RateBudget budget(10);
  EXPECT_EQ(Taken(budget, 5'000'000), 10);
  EXPECT_EQ(Taken(budget, 4'000'000), 0);
  EXPECT_EQ(Taken(budget, 5'000'000), 0) << "the same second again";
  EXPECT_EQ(Taken(budget, 4'500'000), 0);
  EXPECT_EQ(Taken(budget, 5'100'000), 1);
}

TEST(RateBudget, LargeRatesDoNotOverflow) {
  RateBudget budget(4'000'000'000);
  EXPECT_EQ(Taken(budget, 1), 1'000);
  EXPECT_EQ(Taken(budget, std::int64_t{1} << 62), 1'000);
  RateBudget none(0);
  EXPECT_EQ(Taken(none, 1'000'000'000), 0);
}

}  // namespace
}  // namespace furrow::protocol::secure
