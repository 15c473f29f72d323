// SPDX-License-Identifier: Apache-2.0
#include "server/core/metrics.h"

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace furrow::server
