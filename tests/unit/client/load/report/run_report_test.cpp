// SPDX-License-Identifier: Apache-2.0
#include "client/load/report/run_report.h"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/unit/client/load/report/run_report_testing.h"

namespace furrow::load {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string TextOf(const std::function<void(RunResult&)>& change) {
  RunResult result = GoodRun();
  change(result);
  return ToText(result, RunOptions());
}

TEST(Report, AGoodRunGivesNoRemark) {
  const std::string text = TextOf([](RunResult&) {});
  EXPECT_THAT(text, HasSubstr("| offered | sent | expected | received | lost"));
  EXPECT_TRUE(text.ends_with("unchecked: 0.\n")) << text;
}

TEST(Report, EveryDefectOfARunGivesARemark) {
  EXPECT_THAT(TextOf([](RunResult& run) { run.tally.offered = 107; }),
              HasSubstr("7 poses could not be sent when due"));
  EXPECT_THAT(TextOf([](RunResult& run) {
                run.ended_early = true;
                run.complaint = "the daemon closed the connection";
              }),
              HasSubstr("The run ended early: the daemon closed the connection."));
  EXPECT_THAT(TextOf([](RunResult& run) { run.complaint = "too many"; }),
              HasSubstr("Reported during the run: too many."));
  EXPECT_THAT(TextOf([](RunResult& run) { run.interrupted = true; }), HasSubstr("so far"));
  EXPECT_THAT(TextOf([](RunResult& run) { run.overrun = 3; }),
              HasSubstr("The load generator's own buffers lost 3 datagrams"));
  EXPECT_THAT(TextOf([](RunResult& run) { run.tally.unfollowed = 12; }),
              HasSubstr("12 poses had weights that differ from the solver's, too many"));
  EXPECT_THAT(TextOf([](RunResult& run) {
                run.tally.aged = 80;
                run.send_delay_ns.Record(2'800'000'000);
              }),
              HasSubstr("80 messages of decaying weights, because it received no pose of a "
                        "subject for half a second. Poses were sent up to 2.8 s late."));
  EXPECT_THAT(TextOf([](RunResult& run) { run.subscribers_cut = 4; }), HasSubstr("4 times"));
  EXPECT_THAT(TextOf([](RunResult& run) { run.tally.early = 6; }),
              HasSubstr("The weights of 6 poses arrived before the pose was due"));
  EXPECT_THAT(TextOf([](RunResult& run) { run.checked_names = false; }),
              HasSubstr("Weights were not checked"));
  EXPECT_THAT(TextOf([](RunResult& run) {
                for (int i = 0; i < 5; ++i) run.send_delay_ns.Record(900'000);
              }),
              HasSubstr("The load generator sent poses up to 900 us late"));
}

TEST(Report, ReceivedAndExpectedCountPerSubscriber) {
  const std::string text = TextOf([](RunResult& run) {
    run.tally.expected = 200;
    run.tally.received = 198;
  });
  EXPECT_THAT(text, HasSubstr("| 100     | 100  | 200      | 198      | 2    |")) << text;
}

TEST(Report, ReconnectsAndAnUnknownProcessAreReported) {
  RunOptions options;
  options.misbehavior.churn = 2;
  RunResult result = GoodRun();
  result.churn_returns = 1;
  EXPECT_THAT(ToText(result, options), HasSubstr("reconnected 1 time."));
  EXPECT_THAT(TextOf([](RunResult& run) { run.usage_unknown = true; }), HasSubstr("--pid"));
}

TEST(Report, TheLargestDifferenceExcludesWrongWeights) {
  EXPECT_THAT(TextOf([](RunResult& run) { run.tally.wrong = 1; }),
              HasSubstr("largest difference of the correct ones"));
}

TEST(Report, WrongWeightsAreClassified) {
  const std::string text = TextOf([](RunResult& run) {
    run.tally.wrong = 10;
    run.tally.swapped = 4;
    run.tally.unclassified = 3;
  });
  EXPECT_THAT(text, HasSubstr("4 belong to another pose or subject (swapped), 3 match no pose"));
  EXPECT_THAT(text, HasSubstr("3 were not classified"));
  EXPECT_THAT(TextOf([](RunResult& run) { run.tally.wrong = 1; }), Not(HasSubstr("classified")));
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

}  // namespace
}  // namespace furrow::load
