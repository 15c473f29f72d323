// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/status.h"
#include "client/load/measure/spread.h"
#include "client/load/report.h"
#include "client/load/run.h"

namespace furrow::load {

// One figure of a server beside a raw echo's. Ratios are of runs that followed each other, so that
// a machine that slows down slows both; the control is a second raw echo against the first: where
// its spread is wide, the ratio says little.
struct Figure {
  std::string name;
  std::string unit;
  double server = 0.0;  // medians
  double raw = 0.0;
  Spread ratio;
  Spread control;
};

// One that was measured of the server, but not to its end of both echoes.
struct LoneFigure {
  std::string name;
  std::string unit;
  double server = 0.0;  // a median
};

// A search ends where the lowest rate that was not held is at most so many times the highest that
// was: of no ratio of highest rates more is known.
inline constexpr double kSearchPrecision = 1.05;

struct ComparisonOptions {
  RunOptions run;   // at which latency and processor time are compared
  int rounds = 11;  // runs of each
  bool find_max = false;
  int searches = 3;              // of each, for the highest rate
  double probe_seconds = 1.0;    // of one run of a search
  double search_start = 4000.0;  // poses a second; the limit where that is lower
  double search_limit = 400000.0;
  double p99_limit_us = 16667.0;  // for Held()
  // No run begins after so long; where searches and rounds are both wanted, no search's run after
  // three fifths of it. What was measured by then is reported.
  double time_limit_seconds = std::numeric_limits<double>::infinity();
};

// What to measure: the server alone, or with the two echoes.
struct Contestants {
  Target server;
  std::optional<Target> raw;
  std::optional<Target> control;
};

// What was measured, also where it ended before its time.
struct Comparison {
  std::vector<Figure> figures;  // only those that were measured of all three
  std::vector<LoneFigure> not_compared;
  int rounds = 0;                     // runs of the server that were compared
  std::vector<double> highest_rates;  // of the server: one a search; poses a second
  std::vector<RateStep> steps;        // of the server's searches
  // The lowest rate that was given up while this program itself fell behind, where it is below all
  // that were given up otherwise: it may be this program that limits the highest rate.
  std::optional<double> generator_behind_at;
  std::optional<double> raw_generator_behind_at;
  bool at_limit = false;      // a search ended at the limit: the server may take more
  bool unfinished = false;    // the server's only search ran out of time: it may take more
  bool out_of_time = false;   // not all of it was done within the time limit
  bool no_cpu = false;        // rounds were run, but the server's processor time is not known
  bool not_loopback = false;  // the server was compared with echoes that are nearer
  bool interrupted = false;
  Status failure;  // what ended it; ok: nothing did
};

// Runs one target once: in earnest Run() of a performance.
using RunTarget = std::function<Result<RunResult>(const Target& target, const RunOptions& options)>;

// What the caller hears while it lasts; `what` says what is tried now, and what time is left.
struct ComparisonHooks {
  std::function<bool()> go_on;
  std::function<void(const std::string& what)> progress;
  std::function<double()> seconds;  // of a clock that does not go back
};

// Runs all of it, the contestants in turn: in all orders, so that each follows each other equally
// often and none is always measured behind the same. A run that cannot begin is tried once more;
// what fails again, or a server that goes away in a round, ends it.
[[nodiscard]] Comparison Compare(const RunTarget& run, const Contestants& contestants,
                                 const ComparisonOptions& options, const ComparisonHooks& hooks);

}  // namespace furrow::load
