// SPDX-License-Identifier: Apache-2.0
#include "server/core/metrics.h"

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/core/status_line.h"

namespace furrow::server {
namespace {

TEST(Metrics, EveryCounterHasANameOfItsOwnInPrometheusStyle) {
  std::set<std::string> names;
  for (int i = 0; i < static_cast<int>(Counter::kCount); ++i) {
    const std::string name(CounterName(static_cast<Counter>(i)));
    EXPECT_THAT(name, testing::MatchesRegex("furrow_[a-z_]+_total"));
    EXPECT_TRUE(names.insert(name).second) << name;
  }
}

TEST(Metrics, CountsEachForItself) {
  Metrics metrics;
  metrics.Add(Counter::kPosesLate);
  metrics.Add(Counter::kPosesLate, 4);
  EXPECT_EQ(metrics.Get(Counter::kPosesLate), 5u);
  EXPECT_EQ(metrics.Get(Counter::kPosesDuplicate), 0u);
}

TEST(StatusLine, SaysRatesSinceTheLastLineAndOnlyTheDropsThereWere) {
  Metrics metrics;
  StatusLine line(&metrics);
  metrics.Add(Counter::kPosesReceived, 60);
  metrics.Add(Counter::kWeightsSent, 180);
  EXPECT_EQ(line.Next(2, 3, FromSeconds(10)),
            "2 subjects, 3 subscriptions, 60 poses/s, 180 weights/s, 0 pictures/s");
  metrics.Add(Counter::kPosesReceived, 120);
  metrics.Add(Counter::kPosesLate, 4);
  EXPECT_EQ(line.Next(2, 3, FromSeconds(12)),
            "2 subjects, 3 subscriptions, 60 poses/s, 0 weights/s, 0 pictures/s; dropped: 4 late "
            "poses");
  EXPECT_EQ(line.Next(0, 0, FromSeconds(13)),
            "0 subjects, 0 subscriptions, 0 poses/s, 0 weights/s, 0 pictures/s");
}

}  // namespace
}  // namespace furrow::server
