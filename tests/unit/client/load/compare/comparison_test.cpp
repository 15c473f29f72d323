// SPDX-License-Identifier: Apache-2.0
#include "client/load/compare/comparison.h"

#include <algorithm>
#include <map>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "client/load/report/comparison_report.h"

namespace furrow::load {
namespace {

using testing::HasSubstr;
using testing::Not;

// Simulated targets, each with a latency and a highest rate. The clock advances by the length of
// each run.
class ComparisonTest : public testing::Test {
 protected:
  static constexpr double kServerLimit = 20000.0;

  void SetUp() override {
    targets_.server = {.host = "daemon", .pid = 1};
    options_.run.plan.subjects = 10;
    options_.run.plan.seconds = 3.0;
    options_.rounds = 5;
    options_.searches = 2;
  }
  void AddEchoes() {
    targets_.raw = Target{.host = "raw", .echo = true, .pid = 2};
    targets_.control = Target{.host = "control", .echo = true, .pid = 3};
  }

  // Simulates one run, which `change_` may modify.
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
        targets_, options_,
        {.keep_going = [this] { return runs_.size() < interrupt_after_; },
         .progress = [this](const std::string& what) { said_.push_back(what); },
         .seconds = [this] { return now_; }});
  }
  [[nodiscard]] auto RunsOf(const std::string& host) const {
    return std::ranges::count(runs_, host);
  }

  ComparisonTargets targets_;
  ComparisonOptions options_;
  std::function<Result<RunResult>(const Target&, RunResult)> change_ =
      [](const Target&, RunResult result) { return Result<RunResult>(std::move(result)); };
  std::size_t interrupt_after_ = 1'000'000;
  double now_ = 100.0;
  std::vector<std::string> runs_;
  std::vector<double> rates_;
  std::vector<std::string> said_;
};

TEST_F(ComparisonTest, RoundsAlternateAndGiveRatios) {
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

TEST_F(ComparisonTest, EachTargetFollowsEachOtherEquallyOften) {
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

TEST_F(ComparisonTest, AnUnfinishedSearchIsNotCompared) {
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
  EXPECT_THAT(ToText(comparison), HasSubstr("Comparison with a raw UDP echo\n"));
  EXPECT_THAT(ToText(comparison), HasSubstr(" poses per second.\n"));
}

// Without a sustained rate there is no result.
TEST_F(ComparisonTest, ASearchWithoutASustainedRateHasNoHighestRate) {
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

TEST_F(ComparisonTest, ARoundWithoutWeightsHasNoLatency) {
  AddEchoes();
  change_ = [this](const Target&, RunResult result) {
    if (runs_.size() == 1) result.latency_ns = {};
    return Result<RunResult>(std::move(result));
  };
  EXPECT_NEAR(Compare().figures[0].ratio.low, 1.5, 0.01);
}

TEST_F(ComparisonTest, AnUnknownProcessorTimeIsNotCompared) {
  AddEchoes();
  targets_.server.pid.reset();
  const Comparison comparison = Compare();
  EXPECT_EQ(comparison.figures.size(), 2u);
  EXPECT_TRUE(comparison.no_cpu);
  EXPECT_THAT(ToText(comparison), HasSubstr("--pid"));
  EXPECT_THAT(ToText(comparison), Not(HasSubstr("CPU a pose")));
}

TEST_F(ComparisonTest, ARemoteDaemonGivesARemark) {
  AddEchoes();
  EXPECT_THAT(ToText(Compare()), Not(HasSubstr("loopback")));
  targets_.server.loopback = false;
  EXPECT_THAT(ToText(Compare()), HasSubstr("not a loopback address"));
}

TEST_F(ComparisonTest, FindsTheHighestRate) {
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

TEST_F(ComparisonTest, OneSearchIsWrittenInTheSingular) {
  options_.find_max = true;
  options_.searches = 1;
  EXPECT_THAT(ToText(Compare()), HasSubstr(" poses per second (1 search, "));
}

TEST_F(ComparisonTest, ALimitBelowTheStartIsNotExceededAndGivesAtLeast) {
  options_.find_max = true;
  options_.search_limit = 1000.0;
  const Comparison comparison = Compare();
  EXPECT_LE(std::ranges::max(rates_), 1000.0);
  EXPECT_TRUE(comparison.at_limit);
  EXPECT_THAT(ToText(comparison), HasSubstr("at least 1000 poses"));
}

TEST_F(ComparisonTest, TheLimitOfTheGeneratorGivesAtLeast) {
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
  EXPECT_THAT(ToText(comparison), HasSubstr("The load generator could not keep up at 10"));
  EXPECT_THAT(ToText(comparison), HasSubstr("at least"));
  const auto marked = [](const RateStep& step) { return step.generator_behind != step.held; };
  EXPECT_TRUE(std::ranges::all_of(comparison.steps, marked));
}

// The generator falls behind only at rates above the daemon's own limit.
TEST_F(ComparisonTest, AGeneratorThatFallsBehindLaterIsNotTheLimit) {
  options_.find_max = true;
  change_ = [](const Target&, RunResult result) {
    result.overrun = result.planned_rate > 1.5 * kServerLimit ? 1 : 0;
    return Result<RunResult>(std::move(result));
  };
  EXPECT_FALSE(Compare().generator_behind_at);
}

TEST_F(ComparisonTest, AnErrorEndsTheComparisonAndKeepsTheFigures) {
  AddEchoes();
  change_ = [this](const Target&, RunResult result) {
    if (runs_.size() > 9)
      return Result<RunResult>(Status(StatusCode::kUnavailable, "nobody answers"));
    return Result<RunResult>(std::move(result));
  };
  const Comparison comparison = Compare();
  EXPECT_EQ(runs_.size(), 11u);  // the tenth run was tried again
  EXPECT_EQ(comparison.rounds, 3);
  EXPECT_EQ(comparison.figures.size(), 3u);
  EXPECT_EQ(comparison.failure.code(), StatusCode::kUnavailable);
  EXPECT_THAT(ToText(comparison), HasSubstr("The measurement ended early: nobody answers"));
  EXPECT_EQ(ToJson(comparison)["failure"], "nobody answers");
}

TEST_F(ComparisonTest, ATransientFailureIsTriedAgain) {
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

TEST_F(ComparisonTest, ADaemonThatGoesAwayEndsTheRoundsAndFailsTheSearch) {
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

TEST_F(ComparisonTest, NoRunStartsAfterTheTimeLimitAndSearchesLeaveTimeForRounds) {
  AddEchoes();
  options_.find_max = true;
  options_.searches = 100;
  options_.rounds = 1000;
  options_.time_limit_seconds = 200.0;
  const Comparison comparison = Compare();
  EXPECT_TRUE(comparison.out_of_time);
  EXPECT_LE(now_ - 100.0, 200.0 + options_.run.plan.seconds);
  EXPECT_GE(now_ - 100.0, 200.0);
  EXPECT_GE(comparison.rounds, 8);  // 80 s, 3 s per run
  EXPECT_GE(comparison.highest_rates.size(), 1u);
  EXPECT_THAT(said_.front(), HasSubstr("at most 3:20 left"));
  EXPECT_THAT(ToText(comparison), HasSubstr("--time-limit"));
}

TEST_F(ComparisonTest, TheOnlySearchCountsEvenIfUnfinished) {
  options_.find_max = true;
  options_.time_limit_seconds = 4.0;
  const Comparison comparison = Compare();
  EXPECT_EQ(comparison.highest_rates, (std::vector<double>{16000.0}));
  EXPECT_TRUE(comparison.unfinished);
  EXPECT_THAT(ToText(comparison), HasSubstr("at least 16000"));
}

TEST_F(ComparisonTest, AnInterruptKeepsTheFiguresSoFar) {
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
