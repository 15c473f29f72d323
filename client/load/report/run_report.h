// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "client/load/run/run.h"

namespace furrow::load {

// One status line for a run in progress.
[[nodiscard]] std::string LiveLine(double seconds, const Tally& tally, const Histogram& latency_ns);

// Markdown tables of the counts, the latency and the server's resource use, followed by remarks
// about anything that limits what the figures mean.
[[nodiscard]] std::string ToText(const RunResult& result, const RunOptions& options);

[[nodiscard]] nlohmann::json ToJson(const RunResult& result);

}  // namespace furrow::load
