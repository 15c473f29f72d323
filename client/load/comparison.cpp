// SPDX-License-Identifier: Apache-2.0
#include "client/load/comparison.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "client/load/verdict.h"
#include "report/statistics.h"
#include "report/table.h"

namespace furrow::load {
namespace {

using furrow::report::Fixed;
using furrow::report::Median;

// What one contestant measured, one value a run.
struct Series {
  const Target* target = nullptr;
  std::vector<double> p50_us;
  std::vector<double> p90_us;
  std::vector<double> cpu_us;
  Histogram pooled_ns;
  std::vector<double> highest;
};

std::vector<double> Ratios(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (b[i] > 0.0) ratios.push_back(a[i] / b[i]);
  }
  return ratios;
}

// The runs and searches of all contestants, in turn.
class Contest {
 public:
  Contest(const Performance& performance, const Contestants& contestants,
          const ComparisonOptions& options, const ComparisonHooks& hooks)
      : performance_(performance), options_(options), hooks_(hooks) {
    series_.push_back({.target = &contestants.server});
    if (contestants.raw) series_.push_back({.target = &*contestants.raw});
    if (contestants.control) series_.push_back({.target = &*contestants.control});
    run_hooks_ = {.go_on = hooks.go_on,
                  .solving = [](double) {},
                  .second = [](double, const Tally&, const Histogram&) {}};
  }

  Status Rounds();
  Status Searches();
  [[nodiscard]] Comparison Report() const;

 private:
  Status Search();
  Status Probe(Series& series, RateSearch* search);
  void AddFigure(const std::string& name, const std::string& unit,
                 std::vector<double> Series::*values, std::vector<Figure>* figures) const;

  const Performance& performance_;
  const ComparisonOptions& options_;
  const ComparisonHooks& hooks_;
  RunHooks run_hooks_;
  std::vector<Series> series_;
  std::vector<RateStep> steps_;
};

// Another one begins each round, so that none always follows the same.
Status Contest::Rounds() {
  for (int round = 0; round < options_.rounds && hooks_.go_on(); ++round) {
    hooks_.progress("round " + std::to_string(round + 1) + " of " +
                    std::to_string(options_.rounds));
    for (std::size_t i = 0; i < series_.size() && hooks_.go_on(); ++i) {
      Series& series = series_[(i + static_cast<std::size_t>(round)) % series_.size()];
      const auto result = Run(performance_, *series.target, options_.run, run_hooks_);
      if (!result.ok()) return result.status();
      if (result->interrupted) return {};
      series.p50_us.push_back(result->p(50.0));
      series.p90_us.push_back(result->p(90.0));
      series.cpu_us.push_back(result->cpu_us_per_pose().value_or(0.0));
      series.pooled_ns.Add(result->latency_ns);
    }
  }
  return {};
}

Status Contest::Searches() {
  for (int search = 0; search < options_.searches && hooks_.go_on(); ++search) {
    if (Status status = Search(); !status.ok()) return status;
  }
  return {};
}

Status Contest::Search() {
  constexpr double kPrecision = 1.05;
  constexpr int kTries = 2;
  std::vector<RateSearch> searches(
      series_.size(), RateSearch(options_.search_start, options_.search_limit, kPrecision, kTries));
  const auto done = [](const RateSearch& search) { return search.done(); };
  while (!std::ranges::all_of(searches, done) && hooks_.go_on()) {
    for (std::size_t i = 0; i < series_.size() && hooks_.go_on(); ++i) {
      if (searches[i].done()) continue;
      if (Status status = Probe(series_[i], &searches[i]); !status.ok()) return status;
    }
  }
  if (!hooks_.go_on()) return {};
  for (std::size_t i = 0; i < series_.size(); ++i) series_[i].highest.push_back(searches[i].best());
  return {};
}

Status Contest::Probe(Series& series, RateSearch* search) {
  RunOptions run = options_.run;
  run.plan.rate = search->rate() / run.plan.subjects;
  run.plan.seconds = options_.probe_seconds;
  run.drain_seconds = 0.3;
  hooks_.progress(std::string(series.target->echo ? "raw echo" : "daemon") + " at " +
                  Fixed(search->rate(), 0) + " poses a second");
  const auto result = Run(performance_, *series.target, run, run_hooks_);
  if (!result.ok()) return result.status();
  if (result->interrupted) return {};
  const bool held = Held(*result, options_.p99_limit_us);
  search->Tried(held);
  if (!series.target->echo) {
    const Tally& tally = result->tally;
    steps_.push_back({.rate = result->planned_rate,
                      .p50_us = result->p(50.0),
                      .p99_us = result->p(99.0),
                      .lost_share = static_cast<double>(tally.lost()) /
                                    static_cast<double>(std::max<std::uint64_t>(tally.expected, 1)),
                      .held = held});
  }
  return {};
}

void Contest::AddFigure(const std::string& name, const std::string& unit,
                        std::vector<double> Series::*values, std::vector<Figure>* figures) const {
  if (series_.size() < 3 || (series_[2].*values).empty()) return;
  const std::vector<double> ratios = Ratios(series_[0].*values, series_[1].*values);
  const std::vector<double> control = Ratios(series_[2].*values, series_[1].*values);
  if (ratios.empty() || control.empty()) return;
  figures->push_back({name, unit, Median(series_[0].*values), Median(series_[1].*values),
                      SpreadOf(ratios), SpreadOf(control)});
}

Comparison Contest::Report() const {
  Comparison comparison;
  comparison.interrupted = !hooks_.go_on();
  comparison.steps = steps_;
  comparison.highest_rates = series_[0].highest;
  AddFigure("p50", "us", &Series::p50_us, &comparison.figures);
  AddFigure("p90", "us", &Series::p90_us, &comparison.figures);
  AddFigure("CPU a pose", "us", &Series::cpu_us, &comparison.figures);
  AddFigure("highest rate", "poses/s", &Series::highest, &comparison.figures);
  return comparison;
}

}  // namespace

Spread SpreadOf(std::vector<double> values) {
  std::ranges::sort(values);
  const auto at = [&](double share) {
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - std::floor(place)) * (values[above] - values[below]);
  };
  return {at(0.5), at(0.25), at(0.75)};
}

Result<Comparison> Compare(const Performance& performance, const Contestants& contestants,
                           const ComparisonOptions& options, const ComparisonHooks& hooks) {
  Contest contest(performance, contestants, options, hooks);
  if (options.find_max) {
    if (Status status = contest.Searches(); !status.ok()) return status;
  }
  if (contestants.raw) {
    if (Status status = contest.Rounds(); !status.ok()) return status;
  }
  return contest.Report();
}

std::string ToText(const Comparison& comparison) {
  std::string text;
  if (!comparison.figures.empty()) {
    report::Table table{"Beside a raw UDP echo, runs in turn",
                        {"figure", "daemon", "raw echo", "ratio", "middle half of the ratios",
                         "raw against raw", "its middle half"},
                        {}};
    for (const Figure& figure : comparison.figures) {
      const auto between = [](const Spread& spread) {
        return Fixed(spread.low, 2) + " to " + Fixed(spread.high, 2);
      };
      table.rows.push_back({figure.name + ", " + figure.unit, Fixed(figure.server, 1),
                            Fixed(figure.raw, 1), Fixed(figure.ratio.median, 2),
                            between(figure.ratio), Fixed(figure.control.median, 2),
                            between(figure.control)});
    }
    text += ToMarkdown(table);
  }
  if (!comparison.highest_rates.empty()) {
    const Spread spread = SpreadOf(comparison.highest_rates);
    text += "\nHighest rate that loses nothing and holds p99: " + Fixed(spread.median, 0) +
            " poses a second (" + std::to_string(comparison.highest_rates.size()) + " searches, " +
            Fixed(spread.low, 0) + " to " + Fixed(spread.high, 0) + ").\n";
  }
  if (comparison.interrupted) text += "Interrupted: these are the figures so far.\n";
  return text;
}

nlohmann::json ToJson(const Comparison& comparison) {
  const auto spread = [](const Spread& value) {
    return nlohmann::json{{"median", value.median}, {"low", value.low}, {"high", value.high}};
  };
  nlohmann::json figures = nlohmann::json::array();
  for (const Figure& figure : comparison.figures) {
    figures.push_back({{"name", figure.name},
                       {"unit", figure.unit},
                       {"daemon", figure.server},
                       {"raw", figure.raw},
                       {"ratio", spread(figure.ratio)},
                       {"control", spread(figure.control)}});
  }
  nlohmann::json steps = nlohmann::json::array();
  for (const RateStep& step : comparison.steps) {
    steps.push_back({{"rate", step.rate},
                     {"p50_us", step.p50_us},
                     {"p99_us", step.p99_us},
                     {"lost_share", step.lost_share},
                     {"held", step.held}});
  }
  return {{"figures", figures},
          {"highest_rates", comparison.highest_rates},
          {"steps", steps},
          {"interrupted", comparison.interrupted}};
}

}  // namespace furrow::load
