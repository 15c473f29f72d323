// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "client/load/compare/comparison.h"
#include "client/load/run/run.h"

namespace furrow::load {

// Returns charts as one SVG picture: latency by percentile and over time if anything was received,
// and latency and loss by rate if `steps` is not empty.
[[nodiscard]] std::string Plot(const RunResult& result, const std::vector<RateStep>& steps);

}  // namespace furrow::load
