// SPDX-License-Identifier: Apache-2.0
#include "server/shares/work_budget.h"

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// The work that a host gets until `end` if it asks every millisecond.
double Served(WorkBudget* budget, std::uint64_t host, double work, Time begin, Time end) {
  double served = 0.0;
  for (Time now = begin; now < end; now += milliseconds(1)) {
    if (budget->ReadyAt(host) > now) continue;
    budget->Charge(host, work, now);
    served += work;
  }
  return served;
}

TEST(WorkBudget, LimitsTheWorkOfEachHost) {
  WorkBudget budget({.host = 100.0});
  // Ten seconds, the savings of one second, and the last job, which is paid for later.
  EXPECT_NEAR(Served(&budget, 1, 5.0, seconds(100), seconds(110)), 1100.0, 5.0);
  EXPECT_NEAR(Served(&budget, 2, 5.0, seconds(100), seconds(110)), 1100.0, 5.0) << "its own";
}

TEST(WorkBudget, LimitsTheWorkOfAllHosts) {
  WorkBudget budget({.host = 100.0, .total = 150.0});
  double served = 0.0;
  for (Time now = seconds(100); now < seconds(110); now += milliseconds(1)) {
    for (const std::uint64_t host : {1, 2, 3}) {
      if (budget.ReadyAt(host) > now) continue;
      budget.Charge(host, 5.0, now);
      served += 5.0;
    }
  }
  EXPECT_NEAR(served, 1650.0, 5.0);
}

TEST(WorkBudget, AJobLargerThanASecondIsServedAndPaidForAfterwards) {
  WorkBudget budget({.host = 100.0});
  ASSERT_LE(budget.ReadyAt(1), seconds(50));
  budget.Charge(1, 400.0, seconds(50));
  EXPECT_EQ(budget.ReadyAt(1), seconds(53)) << "one of four seconds was saved up";
  EXPECT_LE(budget.ReadyAt(2), seconds(50));
}

TEST(WorkBudget, ADebtEndsAlthoughTheWorkIsHuge) {
  WorkBudget budget({.host = 1e-300, .total = 1.0});
  budget.Charge(1, 1e300, seconds(1));
  EXPECT_LE(budget.ReadyAt(1), seconds(3601));
}

TEST(WorkBudget, WithoutLimitsEverybodyIsServed) {
  WorkBudget budget;
  budget.Charge(1, 1e12, seconds(1));
  EXPECT_LE(budget.ReadyAt(1), seconds(1));
  EXPECT_EQ(budget.num_hosts(), 0u);
}

// Host 1 wants the same pictures as others, so it is charged while it is in debt.
TEST(WorkBudget, SharedWorkPilesUpNoDebt) {
  WorkBudget budget({.host = 100.0});
  for (Time now = seconds(100); now < seconds(200); now += milliseconds(10)) {
    budget.Charge(1, 50.0, now);
  }
  EXPECT_LE(budget.ReadyAt(1), seconds(201));
  budget.Charge(1, 500.0, seconds(200));
  EXPECT_EQ(budget.ReadyAt(1), seconds(205));
}

TEST(WorkBudget, AHostIsLimitedAlthoughManyOthersAreInDebt) {
  WorkBudget budget({.host = 1.0});
  for (std::uint64_t host = 1; host <= WorkBudget::kMaxHosts; ++host) {
    budget.Charge(host, 1000.0, seconds(1));
  }
  EXPECT_NEAR(Served(&budget, 5000, 1.5, seconds(2), seconds(12)), 11.0, 1.5);
}

TEST(WorkBudget, ManyHostsTakeBoundedMemoryAndTheLargestDebtStays) {
  WorkBudget budget({.host = 1.0});
  budget.Charge(0, 1000.0, seconds(1));
  for (std::uint64_t host = 1; host < 5000; ++host) budget.Charge(host, 2.0, seconds(1));
  EXPECT_LE(budget.num_hosts(), WorkBudget::kMaxHosts);
  EXPECT_EQ(budget.ReadyAt(0), seconds(1000));
}

}  // namespace
}  // namespace furrow::server
