// SPDX-License-Identifier: Apache-2.0
#include "lease_simulation.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

namespace furrow::server::testing {
namespace {

// FURROW_LEASE_SCHEDULES=1000000 runs as many; 1 million take some minutes.
std::uint64_t NumSchedules() {
  const char* text = std::getenv("FURROW_LEASE_SCHEDULES");
  return text == nullptr ? 3000 : std::strtoull(text, nullptr, 10);
}

// Any mixture of faults. A rule that is broken fails with the seed of its schedule.
TEST(LeaseSimulation, NoEpochIsServedTwiceAndEverySubjectComesBack) {
  std::uint64_t fenced = 0;
  std::uint64_t overlaps = 0;
  for (std::uint64_t seed = 0; seed < NumSchedules(); ++seed) {
    const LeaseOutcome outcome = SimulateLeases(seed, /*strict=*/false);
    ASSERT_EQ(outcome.fault, "") << "seed " << seed;
    // Three seconds of a foreign lease, or of a store that was emptied, and the way to the node.
    ASSERT_LE(outcome.settled_ms, 8000) << "seed " << seed;
    fenced += outcome.fenced;
    overlaps += outcome.overlaps;
  }
  // The schedules are hard enough: late frames of former holders arrive, and a node that has lost
  // the store serves on beside its successor.
  EXPECT_GT(fenced, 0u);
  EXPECT_GT(overlaps, 0u);
}

// The simulation itself fails where two nodes serve at one time.
TEST(LeaseSimulation, StrictNodesNeverServeAtOneTime) {
  for (std::uint64_t seed = 0; seed < NumSchedules(); ++seed) {
    const LeaseOutcome outcome = SimulateLeases(seed, /*strict=*/true);
    ASSERT_EQ(outcome.fault, "") << "seed " << seed;
    ASSERT_EQ(outcome.overlaps, 0u) << "seed " << seed;
  }
}

struct Single {
  const char* name;
  LeaseFault fault;
  std::int64_t limit_ms;  // docs/CLUSTER.md states them
};

// What one fault alone may cost a receiver.
TEST(LeaseSimulation, OneFaultCostsNoMoreThanStated) {
  const Single singles[] = {{"crash", kCrash, 10'000},
                            {"freeze", kFreeze, 7000},
                            {"cut", kCut, 2500},
                            {"store down", kStoreDown, 2500},
                            {"store emptied", kStoreEmptied, 6000},
                            {"clock step", kClockStep, 1000},
                            {"publisher cut", kPublisherCut, 7000}};
  for (const Single& single : singles) {
    std::int64_t longest_ms = 0;
    for (std::uint64_t seed = 0; seed < NumSchedules() / 10; ++seed) {
      const LeaseOutcome outcome = SimulateLeases(seed, false, single.fault, 1);
      ASSERT_EQ(outcome.fault, "") << single.name << ", seed " << seed;
      longest_ms = std::max(longest_ms, outcome.longest_ms);
    }
    EXPECT_LE(longest_ms, single.limit_ms) << single.name;
  }
}

}  // namespace
}  // namespace furrow::server::testing
