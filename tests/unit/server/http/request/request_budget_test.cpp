// SPDX-License-Identifier: Apache-2.0
#include "server/http/request/request_budget.h"

#include <string>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

constexpr double kShare = 0.1;

// Asks without pause for `seconds`, each request taking `cost` seconds. Returns the time that they
// took together.
double Flood(RequestBudget& budget, const std::string& host, double cost, double seconds,
             double from = 0.0) {
  double used = 0.0;
  for (double at = from; at < from + seconds; at += 1e-3) {
    if (budget.Ask(host, FromSeconds(at)) > 0) continue;
    budget.Charge(host, FromSeconds(cost), FromSeconds(at));
    used += cost;
  }
  return used;
}

TEST(RequestBudget, OneHostGetsItsShare) {
  RequestBudget budget(kShare);
  EXPECT_NEAR(Flood(budget, "a", 1e-3, 60), RequestBudget::kBurstSeconds + 60 * kShare, 0.1);
}

TEST(RequestBudget, AllHostsTogetherGetTwoShares) {
  RequestBudget budget(kShare);
  double used = 0.0;
  for (double at = 0.0; at < 60.0; at += 1e-2) {
    for (int host = 0; host < 20; ++host) {
      const std::string name = std::to_string(host);
      if (budget.Ask(name, FromSeconds(at)) > 0) continue;
      budget.Charge(name, FromSeconds(1e-2), FromSeconds(at));
      used += 1e-2;
    }
  }
  // And each host its reserve.
  const double shares = RequestBudget::kSharesOfAll + 20 * RequestBudget::kReserve;
  EXPECT_LT(used, 1.1 * (60 * kShare * shares + 20 * RequestBudget::kBurstSeconds));
}

TEST(RequestBudget, AModestHostIsServedWhileOthersAskWithoutPause) {
  RequestBudget budget(kShare);
  int refused = 0;
  for (double at = 0.0; at < 60.0; at += 1e-2) {
    for (int host = 0; host < 20; ++host) {
      const std::string name = std::to_string(host);
      if (budget.Ask(name, FromSeconds(at)) == 0) {
        budget.Charge(name, FromSeconds(1e-2), FromSeconds(at));
      }
    }
    // Four times per second.
    if (static_cast<int>(at * 100) % 25 != 0) continue;
    if (budget.Ask("page", FromSeconds(at)) > 0) ++refused;
    budget.Charge("page", FromSeconds(1e-3), FromSeconds(at));
  }
  EXPECT_EQ(refused, 0);
}

TEST(RequestBudget, ALongRequestDelaysItsHostForAWhileOnly) {
  RequestBudget budget(kShare);
  ASSERT_EQ(budget.Ask("a", FromSeconds(1)), 0);
  budget.Charge("a", FromSeconds(100), FromSeconds(1));
  const int wait = budget.Ask("a", FromSeconds(1));
  EXPECT_GT(wait, 0);
  EXPECT_LE(wait, 5);
  EXPECT_EQ(budget.Ask("b", FromSeconds(1)), 0);
  EXPECT_EQ(budget.Ask("a", FromSeconds(1.1 + wait)), 0);
}

TEST(RequestBudget, AShareOfOneIsNoLimit) {
  RequestBudget budget(1.0);
  EXPECT_NEAR(Flood(budget, "a", 1.0, 10), 10'000.0, 2.0);
}

}  // namespace
}  // namespace furrow::server
