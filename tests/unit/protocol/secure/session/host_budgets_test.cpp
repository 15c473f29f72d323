// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/session/host_budgets.h"

#include <gtest/gtest.h>

#include "tests/unit/protocol/secure/secure_testing.h"

namespace furrow::protocol::secure {
namespace {

constexpr std::int64_t kSecond = 1'000'000;

int Taken(HostBudgets& budgets, const PeerAddress& from, std::int64_t now_us,
          const TokenNonce& token = {}) {
  int taken = 0;
  while (taken < 1000 && budgets.Take(from, token, now_us)) ++taken;
  return taken;
}

TEST(HostBudgets, EachHostHasItsOwn) {
  test::RepeatableRandom random(1);
  HostBudgets budgets(20, random);
  EXPECT_EQ(Taken(budgets, test::kHome, kSecond), 20);
  EXPECT_EQ(Taken(budgets, test::kSameHost, kSecond), 0) << "another port of the host";
  EXPECT_EQ(Taken(budgets, test::kAway, kSecond), 20);
  EXPECT_EQ(Taken(budgets, test::kHome, kSecond + kSecond / 2), 10);
}

TEST(HostBudgets, EachTokenOfAHostHasItsOwn) {
  test::RepeatableRandom random(1);
  HostBudgets budgets(20, random);
  EXPECT_EQ(Taken(budgets, test::kHome, kSecond, {1}), 20);
  EXPECT_EQ(Taken(budgets, test::kHome, kSecond, {2}), 20);
  EXPECT_EQ(Taken(budgets, test::kHome, kSecond, {1}), 0);
}

TEST(HostBudgets, AnIpv6NetworkIsOneHost) {
  test::RepeatableRandom random(1);
  HostBudgets budgets(20, random);
  PeerAddress one;
  one.host = {0x20, 1, 0xd, 0xb8, 0, 0, 0, 1, 9, 9, 9, 9, 9, 9, 9, 9};
  PeerAddress neighbour = one;
  neighbour.host[15] = 1;
  PeerAddress other = one;
  other.host[7] = 2;
  EXPECT_EQ(Taken(budgets, one, kSecond), 20);
  EXPECT_EQ(Taken(budgets, neighbour, kSecond), 0);
  EXPECT_EQ(Taken(budgets, other, kSecond), 20);
}

}  // namespace
}  // namespace furrow::protocol::secure
