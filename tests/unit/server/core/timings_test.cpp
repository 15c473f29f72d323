// SPDX-License-Identifier: Apache-2.0
#include "server/core/timings.h"

#include <chrono>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using std::chrono::microseconds;
using std::chrono::seconds;

std::uint64_t CountOf(const Timings::Sum& sum) {
  return std::accumulate(sum.counts.begin(), sum.counts.end(), std::uint64_t{0});
}

TEST(Timings, EveryDurationFallsIntoOneBucket) {
  Timings timings;
  timings.Observe(Timing::kPictureDraw, microseconds(50));  // bounds are inclusive
  timings.Observe(Timing::kPictureDraw, microseconds(51));
  timings.Observe(Timing::kPictureDraw, seconds(10));
  timings.Observe(Timing::kPictureDraw, seconds(11));
  timings.Observe(Timing::kPictureDraw, microseconds(-3));  // a clock that was set back
  const Timings::Sum sum = timings.Get(Timing::kPictureDraw);
  EXPECT_EQ(sum.counts[0], 2u);
  EXPECT_EQ(sum.counts[1], 1u);
  EXPECT_EQ(sum.counts[Timings::kBuckets - 2], 1u);
  EXPECT_EQ(sum.counts[Timings::kBuckets - 1], 1u);
  EXPECT_EQ(CountOf(sum), 5u);
  EXPECT_DOUBLE_EQ(sum.seconds, 21.000101);
  EXPECT_EQ(CountOf(timings.Get(Timing::kPictureWait)), 0u);
}

TEST(Timings, ThreadsAddUp) {
  Timings timings;
  std::vector<std::jthread> threads;
  for (int i = 0; i < 20; ++i) {  // more than there are slots
    threads.emplace_back([&timings] {
      for (int k = 0; k < 100; ++k) timings.Observe(Timing::kReceiveToSend, microseconds(80));
    });
  }
  threads.clear();
  EXPECT_EQ(timings.Get(Timing::kReceiveToSend).counts[1], 2000u);
}

TEST(Timings, HaveNamesOfPrometheusAndSentences) {
  for (int i = 0; i < static_cast<int>(Timing::kCount); ++i) {
    const TimingInfo& info = InfoOf(static_cast<Timing>(i));
    EXPECT_THAT(std::string(info.name), testing::MatchesRegex("furrow_[a-z_]+_seconds"));
    EXPECT_THAT(std::string(info.help), testing::EndsWith("."));
  }
}

}  // namespace
}  // namespace furrow::server
