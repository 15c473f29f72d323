// SPDX-License-Identifier: Apache-2.0
#include "client/load/compare/comparison.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "client/load/compare/rate_search.h"
#include "client/load/run/verdict.h"
#include "report/statistics.h"
#include "report/table.h"

namespace furrow::load {
namespace {

using furrow::report::Fixed;
using furrow::report::Median;

constexpr double kSearchShare = 0.6;  // of the time limit, if rounds follow the searches

// The measurements of one target: one value per round or search.
struct Series {
  using Values = std::vector<std::optional<double>>;

  const Target* target = nullptr;
  Values p50_us;
  Values p90_us;
  Values cpu_us;
  Values highest;
  // The lowest failed rates: with a load generator that fell behind, and with one that did not.
  std::optional<double> generator_behind_at;
  std::optional<double> own_limit_at;

  void AddFailedRate(double rate, bool generator_behind) {
    std::optional<double>& lowest = generator_behind ? generator_behind_at : own_limit_at;
    lowest = std::min(lowest.value_or(rate), rate);
  }
  // The rate at which the generator became the limit; nothing if the target failed at a rate as
  // low.
  [[nodiscard]] std::optional<double> GeneratorLimit() const {
    if (own_limit_at && generator_behind_at && *own_limit_at <= *generator_behind_at) return {};
    return generator_behind_at;
  }
};

// The index of the target that runs i-th in turn `turn` of `count` targets. Every second turn
// reverses the order, and every pair of turns starts with the next target. For three targets, six
// turns cover all orders.
std::size_t InTurn(std::size_t i, std::size_t turn, std::size_t count) {
  const std::size_t place = turn % 2 == 0 ? i : count - 1 - i;
  return (place + turn / 2) % count;
}

// Runs the rounds and searches of all targets alternately.
class Comparer {
 public:
  Comparer(const RunTarget& run, const ComparisonTargets& targets, const ComparisonOptions& options,
           const ComparisonHooks& hooks)
      : run_(run), options_(options), hooks_(hooks), begin_(hooks.seconds()) {
    series_.push_back({.target = &targets.server});
    if (targets.raw) series_.push_back({.target = &*targets.raw});
    if (targets.control) series_.push_back({.target = &*targets.control});
  }

  void Searches();
  void Rounds();
  [[nodiscard]] Comparison Report();

 private:
  // True if another run may start within `share` of the time limit.
  [[nodiscard]] bool MayGoOn(double share);
  void ReportProgress(const std::string& what) const;
  // Returns nothing if the run was interrupted or failed twice.
  [[nodiscard]] std::optional<RunResult> Attempt(const Target& target, const RunOptions& options);
  void Search(double share);
  void Probe(Series& series, RateSearch* search);
  void EndSearch(const std::vector<RateSearch>& searches, bool done);
  void AddFigure(const std::string& name, const std::string& unit, Series::Values Series::*values);

  const RunTarget& run_;
  const ComparisonOptions& options_;
  const ComparisonHooks& hooks_;
  // Start of the time limit, which covers searches and rounds together.
  double begin_;
  std::vector<Series> series_;
  std::size_t turn_ = 0;
  Comparison comparison_;
};

// Called before each run, never during one: a run that was cut short would not be comparable.
bool Comparer::MayGoOn(double share) {
  if (!hooks_.keep_going() || !comparison_.failure.ok()) return false;
  const bool in_time = hooks_.seconds() - begin_ < share * options_.time_limit_seconds;
  comparison_.out_of_time = comparison_.out_of_time || !in_time;
  return in_time;
}

void Comparer::ReportProgress(const std::string& what) const {
  const double left = options_.time_limit_seconds - (hooks_.seconds() - begin_);
  if (!std::isfinite(left)) return hooks_.progress(what);
  const auto seconds = static_cast<int>(std::max(left, 0.0));
  const std::string rest = std::to_string(seconds % 60);
  hooks_.progress(what + ", at most " + std::to_string(seconds / 60) + ":" +
                  (rest.size() < 2 ? "0" : "") + rest + " left");
}

// Runs a target, and once more if it cannot start: the machine may have been busy for a moment.
std::optional<RunResult> Comparer::Attempt(const Target& target, const RunOptions& options) {
  auto result = run_(target, options);
  if (!result.ok() && hooks_.keep_going()) result = run_(target, options);
  if (!result.ok()) {
    comparison_.failure = result.status();
    return std::nullopt;
  }
  if (result->interrupted) return std::nullopt;
  return *std::move(result);
}

void Comparer::Rounds() {
  for (int round = 0; round < options_.rounds && MayGoOn(1.0); ++round) {
    ReportProgress("round " + std::to_string(round + 1) + " of " + std::to_string(options_.rounds));
    const std::size_t turn = turn_++;
    for (std::size_t i = 0; i < series_.size() && MayGoOn(1.0); ++i) {
      Series& series = series_[InTurn(i, turn, series_.size())];
      const auto result = Attempt(*series.target, options_.run);
      if (!result) return;
      // A server that goes away in the middle gives no figures for this round.
      if (result->ended_early) {
        comparison_.failure = {StatusCode::kUnavailable, result->complaint};
        return;
      }
      // A round without measurements keeps its place, so that ratios compare runs of the same
      // round.
      const bool any = result->latency_ns.count() > 0;
      series.p50_us.push_back(any ? std::optional(result->p(50.0)) : std::nullopt);
      series.p90_us.push_back(any ? std::optional(result->p(90.0)) : std::nullopt);
      series.cpu_us.push_back(result->cpu_us_per_pose());
    }
  }
}

void Comparer::Searches() {
  const double share = series_.size() > 1 && options_.rounds > 0 ? kSearchShare : 1.0;
  for (int search = 0; search < options_.searches && MayGoOn(share); ++search) Search(share);
}

void Comparer::Search(double share) {
  constexpr int kTries = 2;
  // All targets are searched alternately, so that a machine that slows down affects all of them.
  std::vector<RateSearch> searches(
      series_.size(), RateSearch(std::min(options_.search_start, options_.search_limit),
                                 options_.search_limit, kSearchPrecision, kTries));
  const auto done = [](const RateSearch& search) { return search.done(); };
  while (!std::ranges::all_of(searches, done) && MayGoOn(share)) {
    const std::size_t turn = turn_++;
    for (std::size_t i = 0; i < series_.size() && MayGoOn(share); ++i) {
      const std::size_t who = InTurn(i, turn, series_.size());
      if (!searches[who].done()) Probe(series_[who], &searches[who]);
    }
  }
  EndSearch(searches, std::ranges::all_of(searches, done));
}

// An unfinished search counts if it is the only one, because the server did sustain its rate. Only
// finished searches are compared with the echoes.
void Comparer::EndSearch(const std::vector<RateSearch>& searches, bool done) {
  if (!done && !(comparison_.out_of_time && series_[0].highest.empty())) return;
  comparison_.unfinished = !searches[0].done();
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const bool counts = i == 0 ? searches[0].done() || searches[0].best() > 0.0
                               : searches[0].done() && searches[i].done();
    series_[i].highest.push_back(counts ? std::optional(searches[i].best()) : std::nullopt);
  }
  comparison_.at_limit = comparison_.at_limit || searches[0].best() >= options_.search_limit;
}

void Comparer::Probe(Series& series, RateSearch* search) {
  RunOptions run = options_.run;
  // The search uses the rate of all subjects, the plan that of one.
  run.plan.rate = search->rate() / run.plan.subjects;
  run.plan.seconds = options_.probe_seconds;
  // A probe that loses weights fails anyway, so it need not wait long for them.
  run.drain_seconds = 0.3;
  ReportProgress(std::string(series.target->echo ? "raw echo" : "daemon") + " at " +
                 Fixed(search->rate(), 0) + " poses per second");
  const auto result = Attempt(*series.target, run);
  if (!result) return;
  const bool held = IsSustained(*result, options_.p99_limit_us);
  const bool behind = !held && GeneratorFellBehind(*result, options_.p99_limit_us);
  const double rate = search->rate();
  search->Report(held);
  // The search moves on after kTries failures. Only then does the rate count as failed.
  if (!held && search->rate() != rate) series.AddFailedRate(rate, behind);
  if (series.target->echo) return;
  const Tally& tally = result->tally;
  comparison_.steps.push_back(
      {.rate = result->planned_rate,
       .p50_us = result->p(50.0),
       .p99_us = result->p(99.0),
       .lost_share = static_cast<double>(tally.lost()) /
                     static_cast<double>(std::max<std::uint64_t>(tally.expected, 1)),
       .held = held,
       .generator_behind = behind});
}

void Comparer::AddFigure(const std::string& name, const std::string& unit,
                         Series::Values Series::*values) {
  // Without the two echoes there is nothing to compare with.
  if (series_.size() < 3) return;
  const std::vector<double> server = Measured(series_[0].*values);
  if (server.empty()) return;
  const std::vector<double> ratios = Ratios(series_[0].*values, series_[1].*values);
  const std::vector<double> control = Ratios(series_[2].*values, series_[1].*values);
  if (ratios.empty() || control.empty()) {
    comparison_.not_compared.push_back({name, unit, Median(server)});
    return;
  }
  comparison_.figures.push_back({name, unit, Median(server), Median(Measured(series_[1].*values)),
                                 QuartilesOf(ratios), QuartilesOf(control)});
}

Comparison Comparer::Report() {
  const Series& server = series_[0];
  comparison_.interrupted = !hooks_.keep_going();
  comparison_.rounds = static_cast<int>(server.p50_us.size());
  comparison_.highest_rates = Measured(server.highest);
  comparison_.no_cpu = !server.cpu_us.empty() && Measured(server.cpu_us).empty();
  comparison_.not_loopback = series_.size() > 1 && !server.target->loopback;
  comparison_.generator_behind_at = server.GeneratorLimit();
  if (series_.size() > 1) comparison_.raw_generator_behind_at = series_[1].GeneratorLimit();
  AddFigure("p50", "us", &Series::p50_us);
  AddFigure("p90", "us", &Series::p90_us);
  AddFigure("CPU a pose", "us", &Series::cpu_us);
  AddFigure("highest rate", "poses/s", &Series::highest);
  return std::move(comparison_);
}

}  // namespace

Comparison Compare(const RunTarget& run, const ComparisonTargets& targets,
                   const ComparisonOptions& options, const ComparisonHooks& hooks) {
  Comparer comparer(run, targets, options, hooks);
  if (options.find_max) comparer.Searches();
  if (targets.raw) comparer.Rounds();
  return comparer.Report();
}

}  // namespace furrow::load
