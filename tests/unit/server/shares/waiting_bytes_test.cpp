// SPDX-License-Identifier: Apache-2.0
#include "server/shares/waiting_bytes.h"

#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using Account = WaitingBytes::Account;
constexpr std::size_t kFree = WaitingBytes::kFree;
constexpr std::size_t kChunk = WaitingBytes::kChunk;

class WaitingBytesTest : public testing::Test {
 protected:
  Metrics metrics;
  WaitingBytes budget{16 * kChunk, &metrics};
};

TEST_F(WaitingBytesTest, ClientsThatKeepUpTakeNothing) {
  std::vector<Account> many;
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(many.emplace_back(&budget, "host").Hold(kFree));
  EXPECT_EQ(budget.taken(), 0u);
}

TEST_F(WaitingBytesTest, OneHostGetsHalfAndTheNextOneFindsRoom) {
  Account slow(&budget, "slow");
  EXPECT_TRUE(slow.Hold(kFree + 8 * kChunk));
  EXPECT_FALSE(slow.Hold(kFree + 8 * kChunk + 1));
  Account second(&budget, "slow");
  EXPECT_FALSE(second.Hold(kFree + 1));
  EXPECT_EQ(budget.taken(), 8 * kChunk);
  Account other(&budget, "other");
  EXPECT_TRUE(other.Hold(kFree + 4 * kChunk));
  EXPECT_EQ(metrics.Get(Counter::kWaitingRefused), 0u);
  second.CountRefusal();
  EXPECT_EQ(metrics.Get(Counter::kWaitingRefused), 1u);
}

TEST_F(WaitingBytesTest, ARefusalChangesNothing) {
  Account slow(&budget, "slow");
  EXPECT_TRUE(slow.Hold(kFree + 2 * kChunk));
  EXPECT_FALSE(slow.Hold(kFree + 100 * kChunk));
  EXPECT_EQ(budget.taken(), 2 * kChunk);
  EXPECT_TRUE(slow.Hold(kFree + 1));
  EXPECT_EQ(budget.taken(), kChunk);
}

TEST_F(WaitingBytesTest, WhatIsReadOrLeavesGivesRoom) {
  std::optional<Account> slow(std::in_place, &budget, "slow");
  ASSERT_TRUE(slow->Hold(kFree + 8 * kChunk));
  Account moved = *std::move(slow);
  slow.reset();
  EXPECT_EQ(budget.taken(), 8 * kChunk);
  EXPECT_TRUE(moved.Hold(0));
  EXPECT_EQ(budget.taken(), 0u);
}

TEST_F(WaitingBytesTest, ASmallerBudgetTakesNothingAway) {
  Account slow(&budget, "slow");
  ASSERT_TRUE(slow.Hold(kFree + 8 * kChunk));
  budget.SetMost(4 * kChunk);
  EXPECT_EQ(budget.taken(), 8 * kChunk);
  Account other(&budget, "other");
  EXPECT_FALSE(other.Hold(kFree + 1));
  EXPECT_TRUE(slow.Hold(kFree + kChunk));
  EXPECT_TRUE(other.Hold(kFree + 1));
}

TEST(WaitingBytes, WithoutABudgetEverythingHasRoom) {
  Account free;
  EXPECT_TRUE(free.Hold(std::size_t{1} << 40));
}

// Whatever clients do, the sum stays within the budget, and nothing is left at the end.
TEST_F(WaitingBytesTest, NeverHoldsMoreThanTheBudget) {
  std::mt19937 random(7);
  std::vector<Account> accounts;
  for (int i = 0; i < 12; ++i) accounts.emplace_back(&budget, "host-" + std::to_string(i % 5));
  for (int step = 0; step < 20'000; ++step) {
    (void)accounts[random() % accounts.size()].Hold(random() % (kFree + 12 * kChunk));
    ASSERT_LE(budget.taken(), 16 * kChunk);
  }
  accounts.clear();
  EXPECT_EQ(budget.taken(), 0u);
}

}  // namespace
}  // namespace furrow::server
