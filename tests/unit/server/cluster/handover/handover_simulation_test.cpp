// SPDX-License-Identifier: Apache-2.0
#include "handover_simulation.h"

#include <charconv>
#include <cstdlib>
#include <numeric>
#include <string>
#include <string_view>
#include <system_error>

#include <gtest/gtest.h>

namespace furrow::server::testing {
namespace {

// FURROW_HANDOVER_SCHEDULES=1000000 runs as many, all tests together. 0: the value is invalid, or
// too small.
std::uint64_t NumSchedules(int share) {
  constexpr std::uint64_t kMost = 1'000'000'000'000;
  const char* given = std::getenv("FURROW_HANDOVER_SCHEDULES");
  const std::string_view text = given == nullptr ? "6000" : given;
  std::uint64_t all = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), all);
  if (error != std::errc() || end != text.data() + text.size() || all > kMost) return 0;
  return all * static_cast<std::uint64_t>(share) / 100;
}

HandoverOutcome RunAll(int share, bool strict, unsigned faults, int most_faults) {
  HandoverOutcome all;
  const std::uint64_t most = NumSchedules(share);
  EXPECT_GT(most, 0u) << "FURROW_HANDOVER_SCHEDULES must be a number of at least 100";
  for (std::uint64_t seed = 1; seed <= most; ++seed) {
    const HandoverOutcome outcome = SimulateHandovers(seed, strict, faults, most_faults);
    all += outcome;
    if (outcome.fault.empty()) continue;
    ADD_FAILURE() << outcome.fault << ", seed " << seed;
    break;
  }
  return all;
}

// Any mixture of faults. A rule that is broken fails with the seed of its schedule.
TEST(HandoverSimulation, NoEpochIsServedTwiceAndNoPoseComesAgain) {
  const HandoverOutcome all = RunAll(50, /*strict=*/false, kAllHandoverFaults, 3);
  EXPECT_LE(all.settled_ms, 8000);
  // The schedules are hard enough, and most hand-overs succeed in spite of it.
  EXPECT_GT(all.warm, all.cold);
  EXPECT_GT(all.cold, 0u);
  EXPECT_GT(all.passed_over, 0u);
  EXPECT_GT(all.fenced, 0u);
  for (std::size_t i = 0; i < all.faults.size(); ++i) {
    EXPECT_GT(all.faults[i], 0u) << "faults of the kind " << (1u << i);
  }
}

TEST(HandoverSimulation, StrictNodesNeverServeAtOneTime) {
  const HandoverOutcome all = RunAll(30, /*strict=*/true, kAllHandoverFaults, 3);
  EXPECT_EQ(all.overlaps, 0u);
  EXPECT_LE(all.settled_ms, 8000);
}

// Nothing fails except the network between nodes, so each state arrives. A store that answers as
// late as it can several times in a row may keep the lease from its heir.
TEST(HandoverSimulation, LossBetweenNodesCostsTimeAndNotTheState) {
  const HandoverOutcome all = RunAll(10, /*strict=*/true, kLinkLoss, 2);
  EXPECT_LE(all.cold, NumSchedules(10) / 2000);
  EXPECT_EQ(all.warm + all.cold, NumSchedules(10));
}

struct Single {
  const char* name;
  HandoverFault fault;
  std::int64_t limit_ms;
};

// What one fault during a hand-over may cost a receiver.
TEST(HandoverSimulation, OneFaultCostsNoMoreThanStated) {
  const Single singles[] = {{"crash", kNodeCrash, 9000},
                            {"freeze", kNodeFreeze, 7000},
                            {"cut from the store", kStoreCut, 7000},
                            {"end of the store", kStoreEnd, 10'000},
                            {"cut of a link", kLinkCut, 3000},
                            {"loss", kLinkLoss, 3000},
                            {"no room", kNodeFull, 3000},
                            {"publisher away", kPublisherAway, 7000},
                            {"another drain", kSecondDrain, 7000},
                            {"short time", kShortTime, 3000}};
  for (const Single& single : singles) {
    SCOPED_TRACE(single.name);
    const HandoverOutcome all = RunAll(1, /*strict=*/false, single.fault, 1);
    EXPECT_GT(std::accumulate(all.faults.begin(), all.faults.end(), std::uint64_t{0}), 0u);
    EXPECT_LE(all.gap_ms, single.limit_ms);
  }
}

}  // namespace
}  // namespace furrow::server::testing
