// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "bench/load/load_setup.h"
#include "client/load/compare/comparison.h"
#include "client/load/schedule/workload.h"

namespace furrow::bench {

// Compares two servers on one core in alternating runs: the server under test and the baseline. A
// second baseline server is the control, which shows the spread of a ratio of 1. The load is 256
// subjects with the recording of the setting, packed.
class PairedRuns {
 public:
  // The caller owns the servers. `searches`: searches for the highest rate of each server, at most
  // the number of rounds.
  PairedRuns(const LoadSetup& setting, const load::ComparisonTargets& contestants, int searches);

  // Runs the rounds of the setting at `rate` poses per second.
  [[nodiscard]] load::Comparison At(double rate);
  // Searches for the highest rate without loss.
  [[nodiscard]] load::Comparison Highest();

 private:
  [[nodiscard]] load::Comparison Run(const load::ComparisonOptions& options);

  load::ComparisonTargets contestants_;
  load::ComparisonOptions options_;
  load::Workload performance_;
};

// The figure of that name, which `comparison` owns; null: it has not been measured.
[[nodiscard]] const load::Figure* FindFigure(const load::Comparison& comparison,
                                             std::string_view name);
// Formats a ratio as median and interquartile range.
[[nodiscard]] std::string Between(const load::Quartiles& ratio);

}  // namespace furrow::bench
