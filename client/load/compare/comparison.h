// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/status.h"
#include "client/load/measure/quartiles.h"
#include "client/load/run/run.h"

namespace furrow::load {

// The outcome of one run of a rate search.
struct RateStep {
  double rate = 0.0;    // poses per second
  double p50_us = 0.0;  // latency, microseconds
  double p99_us = 0.0;
  double lost_share = 0.0;        // fraction of the expected weights that were lost, [0, 1]
  bool held = false;              // the server sustained the rate
  bool generator_behind = false;  // not held, and the load generator was too slow
};

// One figure of a server, compared with a raw echo: a minimal server that returns every datagram.
// Ratios compare runs of one round, so a machine that slows down affects both.
struct Figure {
  std::string name;
  std::string unit;
  double server = 0.0;  // median
  double raw = 0.0;     // median
  Quartiles ratio;      // server / raw echo
  // Second raw echo / first raw echo, ideally 1. If its quartiles are far apart, the machine is too
  // noisy for `ratio` to mean much.
  Quartiles control;
};

// A figure that lacks the measurements of an echo.
struct UnpairedFigure {
  std::string name;
  std::string unit;
  double server = 0.0;  // median
};

// Ratio of the lowest failed rate to the highest sustained rate at which a search ends. Ratios of
// highest rates are only this precise.
inline constexpr double kSearchPrecision = 1.05;

// The options of a comparison.
struct ComparisonOptions {
  RunOptions run;                  // of the rounds, which compare latency and processor time
  int rounds = 11;                 // runs of each target
  bool find_max = false;           // also search for the highest rate
  int searches = 3;                // of each target, for the highest rate
  double probe_seconds = 1.0;      // length of one run of a search
  double search_start = 4000.0;    // poses per second, limited to `search_limit`
  double search_limit = 400000.0;  // poses per second
  double p99_limit_us = 16667.0;   // latency limit of a sustained rate: one frame at 60 Hz
  // No run starts after this time since the start. If rounds follow the searches, no run of a
  // search starts after 60% of it. The report contains what was measured until then.
  double time_limit_seconds = std::numeric_limits<double>::infinity();
};

// The servers to measure: one alone, or with two raw echoes. `raw` and `control` are both set or
// both empty.
struct ComparisonTargets {
  Target server;
  std::optional<Target> raw;
  std::optional<Target> control;
};

// All measurements, even if they ended early.
struct Comparison {
  std::vector<Figure> figures;  // measured on all three targets
  std::vector<UnpairedFigure> not_compared;
  int rounds = 0;                     // rounds of the server
  std::vector<double> highest_rates;  // of the server, poses per second; one per search
  std::vector<RateStep> steps;        // of the server's searches
  // The lowest failed rate with a load generator that fell behind, if it is below all other failed
  // rates. The generator may then be what limits the highest rate.
  std::optional<double> generator_behind_at;      // poses per second, of the server
  std::optional<double> raw_generator_behind_at;  // poses per second, of the raw echo
  bool at_limit = false;      // a search reached its limit; the server may handle more
  bool unfinished = false;    // the only search of the server ran out of time
  bool out_of_time = false;   // the time limit ended the measurement
  bool no_cpu = false;        // rounds ran, but the server's processor time is unknown
  bool not_loopback = false;  // the server is farther away than the echoes
  bool interrupted = false;
  Status failure;  // the error that ended the measurement, or ok
};

// Runs one target once. Programs use Run() with a workload; tests use a fake.
using RunTarget = std::function<Result<RunResult>(const Target& target, const RunOptions& options)>;

// Callbacks during a comparison. `what` names the current run and the time left.
struct ComparisonHooks {
  std::function<bool()> keep_going;  // returning false ends the comparison
  std::function<void(const std::string& what)> progress;
  std::function<double()> seconds;  // monotonic clock
};

// Runs all searches and rounds. The targets alternate in all orders, so that each follows each
// other target equally often. A run that cannot start is tried once more. A second failure, or a
// server that goes away during a round, ends the comparison.
[[nodiscard]] Comparison Compare(const RunTarget& run, const ComparisonTargets& targets,
                                 const ComparisonOptions& options, const ComparisonHooks& hooks);

}  // namespace furrow::load
