// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "client/load/rate_search.h"
#include "client/load/report.h"
#include "client/load/run.h"

namespace furrow::load {

// The middle of many measurements, and between what the middle half of them lies.
struct Spread {
  double median = 0.0;
  double low = 0.0;   // a quarter is below
  double high = 0.0;  // a quarter is above
};

// Of at least one value.
[[nodiscard]] Spread SpreadOf(std::vector<double> values);

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

struct ComparisonOptions {
  RunOptions run;   // at which latency and processor time are compared
  int rounds = 11;  // runs of each
  bool find_max = false;
  int searches = 3;              // of each, for the highest rate
  double probe_seconds = 1.5;    // of one run of a search
  double search_start = 4000.0;  // poses a second
  double search_limit = 400000.0;
  double p99_limit_us =
      16667.0;  // a rate is held when nothing is lost, nothing wrong, and p99 below
};

// What to measure: the server alone, or with the two echoes.
struct Contestants {
  Target server;
  std::optional<Target> raw;
  std::optional<Target> control;
};

struct Comparison {
  std::vector<Figure> figures;
  std::vector<double> highest_rates;  // of the server: one a search; poses a second
  std::vector<RateStep> steps;        // of the server's searches
  bool interrupted = false;
};

// What the caller hears while it lasts; `what` says what is tried now.
struct ComparisonHooks {
  std::function<bool()> go_on;
  std::function<void(const std::string& what)> progress;
};

// Runs all of it, the contestants in turn. Errors: Run()'s.
[[nodiscard]] Result<Comparison> Compare(const Performance& performance,
                                         const Contestants& contestants,
                                         const ComparisonOptions& options,
                                         const ComparisonHooks& hooks);

[[nodiscard]] std::string ToText(const Comparison& comparison);
[[nodiscard]] nlohmann::json ToJson(const Comparison& comparison);

}  // namespace furrow::load
