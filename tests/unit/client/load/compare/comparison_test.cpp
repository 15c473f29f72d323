// SPDX-License-Identifier: Apache-2.0
#include "client/load/compare/comparison.h"

#include <algorithm>
#include <map>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "client/load/compare/comparison_report.h"

namespace furrow::load {
namespace {

using testing::HasSubstr;
using testing::Not;

// Contestants in miniature: each has a latency and a highest rate, and time passes as runs say.
class ComparisonTest : public testing::Test {
 protected:
  static constexpr double kServerLimit = 20000.0;

  void SetUp() override {
    contestants_.server = {.host = "daemon", .pid = 1};
    options_.run.plan.subjects = 10;
    options_.run.plan.seconds = 3.0;
    options_.rounds = 5;
    options_.searches = 2;
  }
  void AddEchoes() {
    contestants_.raw = Target{.host = "raw", .echo = true, .pid = 2};
    contestants_.control = Target{.host = "control", .echo = true, .pid = 3};
  }

  // One run, which `change_` may spoil.
  Result<RunResult> Run(const Target& target, const RunOptions& options) {
    runs_.push_back(target.host);
    now_ += options.plan.seconds;
    const auto count = static_cast<std::uint64_t>(
        std::max(1.0, options.plan.rate * options.plan.subjects * options.plan.seconds));
    const double rate = options.plan.rate * options.plan.subjects;
    rates_.push_back(rate);
    RunResult result;
    result.tally = {.offered = count, .sent = count, .expected = count, .received = count};
    if (rate > (target.echo ? 2.0 : 1.0) * kServerLimit) result.tally.received -= count / 10;
    result.planned_rate = rate;
    for (int i = 0; i < 100; ++i) {
      result.latency_ns.Record(target.echo ? 100'000 : 150'000);
      result.send_delay_ns.Record(1000);
    }
    if (target.pid) result.cpu_seconds = 1e-6 * static_cast<double>(count * (target.echo ? 4 : 6));
    return change_(target, std::move(result));
  }
  Comparison Compare() {
    return load::Compare(
        [this](const Target& target, const RunOptions& options) { return Run(target, options); },
        contestants_, options_,
        {.go_on = [this] { return runs_.size() < interrupt_after_; },
         .progress = [this](const std::string& what) { said_.push_back(what); },
         .seconds = [this] { return now_; }});
  }
  [[nodiscard]] auto RunsOf(const std::string& host) const {
    return std::ranges::count(runs_, host);
  }

  Contestants contestants_;
  ComparisonOptions options_;
  std::function<Result<RunResult>(const Target&, RunResult)> change_ =
      [](const Target&, RunResult result) { return Result<RunResult>(std::move(result)); };
  std::size_t interrupt_after_ = 1'000'000;
  double now_ = 100.0;
  std::vector<std::string> runs_;
  std::vector<double> rates_;
  std::vector<std::string> said_;
};

TEST_F(ComparisonTest, RoundsAreOfAllInTurnAndGiveRatios) {
  AddEchoes();
  options_.run.plan.rate = 100.0;
  const Comparison comparison = Compare();
  EXPECT_EQ(runs_.size(), 15u);
  EXPECT_EQ(runs_[0], "daemon");
  EXPECT_EQ(runs_[3], "control");
  EXPECT_EQ(comparison.rounds, 5);
  ASSERT_EQ(comparison.figures.size(), 3u);
  EXPECT_EQ(comparison.figures[0].name, "p50");
  EXPECT_NEAR(comparison.figures[0].ratio.median, 1.5, 0.01);
  EXPECT_NEAR(comparison.figures[0].control.median, 1.0, 0.01);
  EXPECT_EQ(comparison.figures[2].name, "CPU a pose");
  EXPECT_NEAR(comparison.figures[2].ratio.median, 1.5, 1e-9);
  EXPECT_FALSE(comparison.no_cpu || comparison.out_of_time || comparison.interrupted);
}

TEST_F(ComparisonTest, EachFollowsEachOtherEquallyOften) {
  AddEchoes();
  options_.rounds = 6;
  (void)Compare();
  ASSERT_EQ(runs_.size(), 18u);
  std::map<std::pair<std::string, std::string>, int> follows;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    if (i % 3 != 0) ++follows[{runs_[i - 1], runs_[i]}];
  }
  EXPECT_EQ(follows.size(), 6u);
  for (const auto& [pair, count] : follows) EXPECT_EQ(count, 2) << pair.first << pair.second;
}

TEST_F(ComparisonTest, ASearchCutShortIsNotCompared) {
  AddEchoes();
  options_.find_max = true;
  options_.rounds = 0;
  options_.time_limit_seconds = 7.0;
  const Comparison comparison = Compare();
  EXPECT_TRUE(comparison.unfinished);
  EXPECT_TRUE(comparison.figures.empty());
  ASSERT_EQ(comparison.not_compared.size(), 1u);
  EXPECT_EQ(comparison.not_compared[0].server, comparison.highest_rates[0]);
  EXPECT_THAT(ToText(comparison),
              testing::ContainsRegex("highest rate, poses/s [|] [0-9.]+ +[|] - "));
  EXPECT_TRUE(ToJson(comparison)["figures"][0]["ratio"].is_null());
  EXPECT_TRUE(ToJson(comparison)["figures"][0]["raw"].is_null());
  EXPECT_THAT(ToText(comparison), HasSubstr("Beside a raw UDP echo\n"));
  EXPECT_THAT(ToText(comparison), HasSubstr(" poses a second.\n"));
}

// Where nothing was tried at all, nothing is known.
TEST_F(ComparisonTest, ASearchThatHeldNothingYetHasNoHighestRate) {
  options_.find_max = true;
  options_.time_limit_seconds = 0.5;
  change_ = [](const Target&, RunResult result) {
    --result.tally.received;
    return Result<RunResult>(std::move(result));
  };
  const Comparison comparison = Compare();
  EXPECT_TRUE(comparison.unfinished);
  EXPECT_TRUE(comparison.highest_rates.empty());
  EXPECT_THAT(ToText(comparison), Not(HasSubstr("Highest rate")));
}

TEST_F(ComparisonTest, ARoundThatBroughtNothingIsNoLatency) {
  AddEchoes();
  change_ = [this](const Target&, RunResult result) {
    if (runs_.size() == 1) result.latency_ns = {};
    return Result<RunResult>(std::move(result));
  };
  EXPECT_NEAR(Compare().figures[0].ratio.low, 1.5, 0.01);
}

TEST_F(ComparisonTest, AnUnknownProcessTimeIsNotComparedAsZero) {
  AddEchoes();
  contestants_.server.pid.reset();
  const Comparison comparison = Compare();
  EXPECT_EQ(comparison.figures.size(), 2u);
  EXPECT_TRUE(comparison.no_cpu);
  EXPECT_THAT(ToText(comparison), HasSubstr("--pid"));
  EXPECT_THAT(ToText(comparison), Not(HasSubstr("CPU a pose")));
}

TEST_F(ComparisonTest, ARemoteDaemonBesideEchoesOfThisMachineIsRemarkedOn) {
  AddEchoes();
  EXPECT_THAT(ToText(Compare()), Not(HasSubstr("loopback")));
  contestants_.server.loopback = false;
  EXPECT_THAT(ToText(Compare()), HasSubstr("not a loopback address"));
}

TEST_F(ComparisonTest, TheHighestRateIsFound) {
  options_.find_max = true;
  const Comparison comparison = Compare();
  EXPECT_EQ(comparison.highest_rates.size(), 2u);
  for (const double rate : comparison.highest_rates) {
    EXPECT_LE(rate, kServerLimit);
    EXPECT_GE(rate, kServerLimit / 1.05);
  }
  EXPECT_EQ(comparison.steps.size(), runs_.size());
  EXPECT_FALSE(comparison.generator_behind_at);
  EXPECT_THAT(ToText(comparison), Not(HasSubstr("at least")));
}

TEST_F(ComparisonTest, OneSearchIsCalledOne) {
  options_.find_max = true;
  options_.searches = 1;
  EXPECT_THAT(ToText(Compare()), HasSubstr(" poses a second (1 search, "));
}

TEST_F(ComparisonTest, ALimitBelowTheStartIsNotExceededAndSaysAtLeast) {
  options_.find_max = true;
  options_.search_limit = 1000.0;
  const Comparison comparison = Compare();
  EXPECT_LE(std::ranges::max(rates_), 1000.0);
  EXPECT_TRUE(comparison.at_limit);
  EXPECT_THAT(ToText(comparison), HasSubstr("at least 1000 poses"));
}

TEST_F(ComparisonTest, TheGeneratorsLimitIsNotCalledTheDaemons) {
  options_.find_max = true;
  change_ = [](const Target&, RunResult result) {
    if (result.planned_rate > 10000.0) {
      --result.tally.received;
      result.overrun = 1;
    }
    return Result<RunResult>(std::move(result));
  };
  const Comparison comparison = Compare();
  ASSERT_TRUE(comparison.generator_behind_at);
  EXPECT_GT(*comparison.generator_behind_at, 10000.0);
  EXPECT_LT(*comparison.generator_behind_at, 10500.0);
  EXPECT_THAT(ToText(comparison), HasSubstr("The generator could not keep up at 10"));
  EXPECT_THAT(ToText(comparison), HasSubstr("at least"));
  const auto marked = [](const RateStep& step) { return step.generator_behind != step.held; };
  EXPECT_TRUE(std::ranges::all_of(comparison.steps, marked));
}

// Only far beyond what the daemon holds anyway: its limit is its own.
TEST_F(ComparisonTest, AGeneratorThatFallsBehindLaterIsNoLimit) {
  options_.find_max = true;
  change_ = [](const Target&, RunResult result) {
    result.overrun = result.planned_rate > 1.5 * kServerLimit ? 1 : 0;
    return Result<RunResult>(std::move(result));
  };
  EXPECT_FALSE(Compare().generator_behind_at);
}

TEST_F(ComparisonTest, AnErrorEndsItButNothingIsForgotten) {
  AddEchoes();
  change_ = [this](const Target&, RunResult result) {
    if (runs_.size() > 9)
      return Result<RunResult>(Status(StatusCode::kUnavailable, "nobody answers"));
    return Result<RunResult>(std::move(result));
  };
  const Comparison comparison = Compare();
  EXPECT_EQ(runs_.size(), 11u);  // the tenth was tried again
  EXPECT_EQ(comparison.rounds, 3);
  EXPECT_EQ(comparison.figures.size(), 3u);
  EXPECT_EQ(comparison.failure.code(), StatusCode::kUnavailable);
  EXPECT_THAT(ToText(comparison), HasSubstr("Ended before its time: nobody answers"));
  EXPECT_EQ(ToJson(comparison)["failure"], "nobody answers");
}

TEST_F(ComparisonTest, AFailureThatPassesCostsNothing) {
  AddEchoes();
  change_ = [this](const Target&, RunResult result) {
    if (runs_.size() == 5)
      return Result<RunResult>(Status(StatusCode::kUnavailable, "nobody answers"));
    return Result<RunResult>(std::move(result));
  };
  const Comparison comparison = Compare();
  EXPECT_EQ(comparison.rounds, 5);
  EXPECT_TRUE(comparison.failure.ok());
}

TEST_F(ComparisonTest, ADaemonThatGoesAwayEndsTheRoundsButIsNotHeldInASearch) {
  AddEchoes();
  options_.find_max = true;
  change_ = [this](const Target& target, RunResult result) {
    result.ended_early = !target.echo && (result.planned_rate > 10000.0 || RunsOf("daemon") > 40);
    result.complaint = "gone";
    return Result<RunResult>(std::move(result));
  };
  const Comparison found = Compare();
  EXPECT_LE(found.highest_rates[0], 10000.0);
  EXPECT_EQ(found.rounds, 5);
  options_.find_max = false;
  options_.rounds = 50;
  const Comparison ended = Compare();
  EXPECT_FALSE(ended.failure.ok());
  EXPECT_THAT(ToText(ended), HasSubstr("gone"));
}

TEST_F(ComparisonTest, NoRunBeginsBeyondTheTimeAndSearchesLeaveSomeForRounds) {
  AddEchoes();
  options_.find_max = true;
  options_.searches = 100;
  options_.rounds = 1000;
  options_.time_limit_seconds = 200.0;
  const Comparison comparison = Compare();
  EXPECT_TRUE(comparison.out_of_time);
  EXPECT_LE(now_ - 100.0, 200.0 + options_.run.plan.seconds);
  EXPECT_GE(now_ - 100.0, 200.0);
  EXPECT_GE(comparison.rounds, 8);  // 80 s of runs of 3 s
  EXPECT_GE(comparison.highest_rates.size(), 1u);
  EXPECT_THAT(said_.front(), HasSubstr("at most 3:20 left"));
  EXPECT_THAT(ToText(comparison), HasSubstr("--time-limit"));
}

TEST_F(ComparisonTest, TheOnlySearchCountsAlsoWhenItWasCutShort) {
  options_.find_max = true;
  options_.time_limit_seconds = 4.0;
  const Comparison comparison = Compare();
  EXPECT_EQ(comparison.highest_rates, (std::vector<double>{16000.0}));
  EXPECT_TRUE(comparison.unfinished);
  EXPECT_THAT(ToText(comparison), HasSubstr("at least 16000"));
}

TEST_F(ComparisonTest, AnInterruptLeavesTheFiguresSoFar) {
  AddEchoes();
  interrupt_after_ = 7;
  const Comparison comparison = Compare();
  EXPECT_TRUE(comparison.interrupted);
  EXPECT_EQ(runs_.size(), 7u);
  EXPECT_EQ(comparison.figures.size(), 3u);
  EXPECT_THAT(ToText(comparison), HasSubstr("Interrupted"));
}

}  // namespace
}  // namespace furrow::load
