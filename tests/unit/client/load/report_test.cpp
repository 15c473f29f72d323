// SPDX-License-Identifier: Apache-2.0
#include "client/load/report.h"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace furrow::load {
namespace {

using testing::HasSubstr;
using testing::Not;

RunResult GoodRun() {
  RunResult result;
  result.tally = {.offered = 100, .sent = 100, .expected = 100, .received = 100, .checked = 100};
  for (int i = 0; i < 100; ++i) {
    result.latency_ns.Record(1'000'000);
    result.send_delay_ns.Record(1'000);
  }
  result.windows.resize(50);
  for (int i = 0; i < 10; ++i) result.windows[static_cast<std::size_t>(i)].Record(1'000'000 + i);
  result.seconds = 10.0;
  result.planned_seconds = 10.0;
  result.checked_names = true;
  return result;
}

std::string TextOf(const std::function<void(RunResult&)>& change) {
  RunResult result = GoodRun();
  change(result);
  return ToText(result, RunOptions());
}

TEST(Report, AGoodRunIsNotRemarkedOn) {
  const std::string text = TextOf([](RunResult&) {});
  EXPECT_THAT(text, HasSubstr("| offered | sent | expected | received | lost"));
  EXPECT_TRUE(text.ends_with("not to be checked: 0.\n")) << text;
}

TEST(Report, WhatSpoilsARunIsSaid) {
  EXPECT_THAT(TextOf([](RunResult& run) { run.tally.offered = 107; }),
              HasSubstr("7 poses did not leave when due"));
  EXPECT_THAT(TextOf([](RunResult& run) {
                run.ended_early = true;
                run.complaint = "the daemon closed the connection";
              }),
              HasSubstr("Ended before its time: the daemon closed the connection."));
  EXPECT_THAT(TextOf([](RunResult& run) { run.complaint = "too many"; }),
              HasSubstr("Said meanwhile: too many."));
  EXPECT_THAT(TextOf([](RunResult& run) { run.interrupted = true; }), HasSubstr("so far"));
  EXPECT_THAT(TextOf([](RunResult& run) { run.overrun = 3; }),
              HasSubstr("This program's own buffers lost 3 datagrams"));
  EXPECT_THAT(TextOf([](RunResult& run) { run.tally.unfollowed = 12; }),
              HasSubstr("12 poses had weights that differ from the solver's, too many"));
  EXPECT_THAT(TextOf([](RunResult& run) { run.burdens_cut = 4; }), HasSubstr("4 times"));
  EXPECT_THAT(TextOf([](RunResult& run) { run.tally.early = 6; }),
              HasSubstr("Before their pose was due came the weights of 6 poses"));
  EXPECT_THAT(TextOf([](RunResult& run) { run.checked_names = false; }),
              HasSubstr("Weights were not checked"));
  EXPECT_THAT(TextOf([](RunResult& run) {
                for (int i = 0; i < 5; ++i) run.send_delay_ns.Record(900'000);
              }),
              HasSubstr("This program sent poses up to 900 us late"));
}

TEST(Report, ReceivedStandsBesideWhatSeveralSubscribersExpect) {
  const std::string text = TextOf([](RunResult& run) {
    run.tally.expected = 200;
    run.tally.received = 198;
  });
  EXPECT_THAT(text, HasSubstr("| 100     | 100  | 200      | 198      | 2    |")) << text;
}

TEST(Report, BurdensAndAProcessThatIsNotKnownAreSaid) {
  RunOptions options;
  options.burdens.churn = 2;
  RunResult result = GoodRun();
  result.churn_returns = 1;
  EXPECT_THAT(ToText(result, options), HasSubstr("left and came back 1 time."));
  EXPECT_THAT(TextOf([](RunResult& run) { run.usage_unknown = true; }), HasSubstr("--pid"));
}

TEST(Report, TheLargestDifferenceIsSaidToLeaveOutTheWrong) {
  EXPECT_THAT(TextOf([](RunResult& run) { run.tally.wrong = 1; }),
              HasSubstr("largest difference of the right ones"));
}

TEST(Report, TheWrongAreToldApart) {
  const std::string text = TextOf([](RunResult& run) {
    run.tally.wrong = 10;
    run.tally.swapped = 4;
    run.tally.unclassified = 3;
  });
  EXPECT_THAT(text, HasSubstr("4 are another pose's or subject's (swapped), 3 nobody's"));
  EXPECT_THAT(text, HasSubstr("3 were not looked for"));
  EXPECT_THAT(TextOf([](RunResult& run) { run.tally.wrong = 1; }), Not(HasSubstr("looked for")));
}

TEST(Report, JsonHoldsTheCountsAndHowItEnded) {
  RunResult result = GoodRun();
  result.ended_early = true;
  result.tally.received = 98;
  const nlohmann::json json = ToJson(result);
  EXPECT_EQ(json["lost"], 2);
  EXPECT_EQ(json["ended_early"], true);
  EXPECT_EQ(json["interrupted"], false);
  EXPECT_FALSE(json.contains("cpu_seconds"));
}

// Windows are parts of what was planned: where they stand does not depend on when it ended.
TEST(Report, AnInterruptedRunIsDrawnInItsOwnTime) {
  RunResult cut = GoodRun();
  cut.seconds = 2.0;
  EXPECT_EQ(Plot(cut, {}), Plot(GoodRun(), {}));
  RunResult longer = GoodRun();
  longer.planned_seconds = 20.0;
  EXPECT_NE(Plot(longer, {}), Plot(GoodRun(), {}));
}

TEST(Report, P99IsDrawnAboveTheMaximum) {
  const std::string svg = Plot(GoodRun(), {});
  EXPECT_LT(svg.find(">max<"), svg.find(">p99<"));
}

TEST(Report, WithoutARunOnlyStepsAreDrawn) {
  const std::string svg = Plot(RunResult(), {{.rate = 1000.0, .p50_us = 10.0, .p99_us = 20.0}});
  EXPECT_THAT(svg, HasSubstr("Loss by rate"));
  EXPECT_THAT(svg, Not(HasSubstr("Latency by percentile")));
}

}  // namespace
}  // namespace furrow::load
