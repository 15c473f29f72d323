// SPDX-License-Identifier: Apache-2.0
#include "client/load/run/verdict.h"

#include <functional>

#include <gtest/gtest.h>

namespace furrow::load {
namespace {

constexpr double kLimitUs = 1000.0;

// A thousand poses with correct weights after 100 us.
RunResult GoodRun() {
  RunResult result;
  result.tally = {
      .offered = 1000, .sent = 1000, .expected = 1000, .received = 1000, .checked = 1000};
  for (int i = 0; i < 1000; ++i) {
    result.latency_ns.Record(100'000);
    result.send_delay_ns.Record(5'000);
  }
  result.checked_names = true;
  return result;
}

RunResult But(const std::function<void(RunResult&)>& change) {
  RunResult result = GoodRun();
  change(result);
  return result;
}

TEST(Verdict, AGoodRunIsSustainedAndClean) {
  EXPECT_TRUE(IsSustained(GoodRun(), kLimitUs));
  EXPECT_TRUE(IsClean(GoodRun()));
  EXPECT_FALSE(GeneratorFellBehind(GoodRun(), kLimitUs));
}

TEST(Verdict, AnIncompleteRunIsNeitherSustainedNorClean) {
  const std::function<void(RunResult&)> faults[] = {[](RunResult& run) { run.tally.received = 999; },
                                                    [](RunResult& run) { run.tally.wrong = 1; },
                                                    [](RunResult& run) { run.tally.never_sent = 1; },
                                                    [](RunResult& run) { run.tally.offered = 1001; },
                                                    [](RunResult& run) { run.ended_early = true; },
                                                    [](RunResult& run) { run.interrupted = true; }};
  int i = 0;
  for (const auto& fault : faults) {
    EXPECT_FALSE(IsSustained(But(fault), kLimitUs)) << i;
    EXPECT_FALSE(IsClean(But(fault))) << i;
    ++i;
  }
}

// Early arrivals are a property of this machine's clocks and not of the server.
TEST(Verdict, EarlyArrivalsAreClean) {
  EXPECT_TRUE(IsClean(But([](RunResult& run) { run.tally.early = 1; })));
}

TEST(Verdict, LateUncheckedAndMalformedWeightsAreSustainedButNotClean) {
  const std::function<void(RunResult&)> faults[] = {
      [](RunResult& run) { run.tally.late = 1; }, [](RunResult& run) { run.tally.unchecked = 1; },
      [](RunResult& run) { run.malformed = 1; }, [](RunResult& run) { run.checked_names = false; }};
  int i = 0;
  for (const auto& fault : faults) {
    EXPECT_TRUE(IsSustained(But(fault), kLimitUs)) << i;
    EXPECT_FALSE(IsClean(But(fault))) << i;
    ++i;
  }
}

TEST(Verdict, SustainedDependsOnThePercentile) {
  EXPECT_FALSE(IsSustained(GoodRun(), 100.0));
  EXPECT_TRUE(IsSustained(GoodRun(), 100.5));
}

TEST(Verdict, TheGeneratorFellBehindIfItSentLateOrLostDatagrams) {
  EXPECT_TRUE(GeneratorFellBehind(But([](RunResult& run) { run.overrun = 1; }), kLimitUs));
  EXPECT_TRUE(GeneratorFellBehind(But([](RunResult& run) { run.tally.offered = 1001; }), kLimitUs));
  const auto slow = [](RunResult& run) {
    for (int i = 0; i < 20; ++i) run.send_delay_ns.Record(600'000);
  };
  EXPECT_TRUE(GeneratorFellBehind(But(slow), kLimitUs));
  EXPECT_FALSE(GeneratorFellBehind(But(slow), 2.0 * kLimitUs));
}

}  // namespace
}  // namespace furrow::load
