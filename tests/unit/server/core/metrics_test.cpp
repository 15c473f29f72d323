// SPDX-License-Identifier: Apache-2.0
#include "server/core/metrics.h"

#include <cstdint>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/config/config.h"

namespace furrow::server {
namespace {

TEST(Metrics, EveryCounterHasAUniquePrometheusNameAndHelp) {
  std::set<std::string> names;
  for (int i = 0; i < static_cast<int>(Counter::kCount); ++i) {
    const std::string name(CounterName(static_cast<Counter>(i)));
    EXPECT_THAT(name, testing::MatchesRegex("furrow_[a-z_]+_total"));
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_THAT(std::string(CounterHelp(static_cast<Counter>(i))), testing::EndsWith(".")) << name;
  }
}

TEST(Metrics, CountersAreIndependent) {
  Metrics metrics;
  metrics.Add(Counter::kPosesLate);
  metrics.Add(Counter::kPosesLate, 4);
  EXPECT_EQ(metrics.Get(Counter::kPosesLate), 5u);
  EXPECT_EQ(metrics.Get(Counter::kPosesDuplicate), 0u);
}

// More threads than slots, so that some share one.
TEST(Metrics, ThreadsCountAtTheSameTime) {
  constexpr std::uint64_t kTimes = 4'000;
  Metrics metrics;
  std::vector<std::jthread> threads;
  for (std::size_t i = 0; i < 2 * kThreadSlots; ++i) {
    threads.emplace_back([&metrics] {
      for (std::uint64_t time = 0; time < kTimes; ++time) metrics.Add(Counter::kPosesLate, 3);
    });
  }
  threads.clear();
  EXPECT_EQ(metrics.Get(Counter::kPosesLate), 3 * kTimes * 2 * kThreadSlots);
}

TEST(Metrics, FirstThreadsHaveSlotsOfTheirOwn) {
  static_assert(kOwnSlots >= kMaxThreads + 10, "threads of the network, and others");
  std::set<std::size_t> own;
  for (std::size_t number = 0; number < kOwnSlots; ++number) own.insert(SlotOfNumber(number));
  EXPECT_EQ(own.size(), kOwnSlots);
  EXPECT_LT(*own.rbegin(), kOwnSlots);
  for (std::size_t number = kOwnSlots; number < 4 * kThreadSlots; ++number) {
    EXPECT_GE(SlotOfNumber(number), kOwnSlots) << number;
    EXPECT_LT(SlotOfNumber(number), kThreadSlots) << number;
  }
}

TEST(Metrics, AThreadKeepsItsSlot) {
  const std::size_t slot = SlotOfThread();
  std::jthread([] { (void)SlotOfThread(); }).join();
  EXPECT_EQ(SlotOfThread(), slot);
  EXPECT_LT(slot, kThreadSlots);
}

}  // namespace
}  // namespace furrow::server
