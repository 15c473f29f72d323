// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/load/load_setup.h"
#include "client/load/compare/comparison.h"

namespace furrow::bench {

// Compares a daemon with several threads to a daemon with one thread, which is also the control.
struct ThreadsResult {
  int threads = 0;
  load::Comparison steady;   // at 50,000 poses per second
  load::Comparison highest;  // one search per daemon for the highest rate without loss
};

// Measures daemons with 2 and 4 threads, and with more on machines with at least 16 cores. On a
// machine with two cores, every daemon has only one core. There the result shows the cost of
// further threads but not their benefit.
[[nodiscard]] std::vector<ThreadsResult> MeasureThreads(const LoadSetup& setting);

[[nodiscard]] std::string ToMarkdown(const std::vector<ThreadsResult>& results);
[[nodiscard]] nlohmann::json ToJson(const std::vector<ThreadsResult>& results);

}  // namespace furrow::bench
