// SPDX-License-Identifier: Apache-2.0
#include "client/load/report/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/client/load/report/run_report_testing.h"

namespace furrow::load {
namespace {

using testing::HasSubstr;
using testing::Not;

// Windows are parts of the planned time, so an early end does not move them.
TEST(Plot, AnInterruptedRunKeepsItsTimeAxis) {
  RunResult cut = GoodRun();
  cut.seconds = 2.0;
  EXPECT_EQ(Plot(cut, {}), Plot(GoodRun(), {}));
  RunResult longer = GoodRun();
  longer.planned_seconds = 20.0;
  EXPECT_NE(Plot(longer, {}), Plot(GoodRun(), {}));
}

TEST(Plot, P99IsDrawnOverTheMaximum) {
  const std::string svg = Plot(GoodRun(), {});
  EXPECT_LT(svg.find(">max<"), svg.find(">p99<"));
}

TEST(Plot, WithoutARunOnlyTheStepsAreDrawn) {
  const std::string svg = Plot(RunResult(), {{.rate = 1000.0, .p50_us = 10.0, .p99_us = 20.0}});
  EXPECT_THAT(svg, HasSubstr("Loss by rate"));
  EXPECT_THAT(svg, Not(HasSubstr("Latency by percentile")));
}

}  // namespace
}  // namespace furrow::load
