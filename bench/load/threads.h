// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/load/setting.h"
#include "client/load/compare/comparison.h"

namespace furrow::bench {

// A daemon of several threads beside one of one thread, which also stands in for its control.
struct ThreadsResult {
  int threads = 0;
  load::Comparison steady;   // at 50,000 poses a second
  load::Comparison highest;  // one search of each for the highest rate without loss
};

// Daemons of 2 and of 4 threads. On a machine of two cores all have one of them, however many
// threads: there it says what a thread more costs, and cannot say what it gains.
[[nodiscard]] std::vector<ThreadsResult> MeasureThreads(const Setting& setting);

[[nodiscard]] std::string ToMarkdown(const std::vector<ThreadsResult>& results);
[[nodiscard]] nlohmann::json ToJson(const std::vector<ThreadsResult>& results);

}  // namespace furrow::bench
