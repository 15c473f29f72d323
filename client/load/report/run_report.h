// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "client/load/run/run.h"

namespace furrow::load {

// Returns one status line for a run in progress. `seconds`: since the start of the run.
[[nodiscard]] std::string LiveLine(double seconds, const Tally& tally, const Histogram& latency_ns);

// Returns Markdown: tables of the counts, the latency and the server's resource use, followed by
// remarks about anything that makes the figures less reliable.
[[nodiscard]] std::string ToText(const RunResult& result, const RunOptions& options);

// Returns the counts, the latency and the resource use as a JSON object.
[[nodiscard]] nlohmann::json ToJson(const RunResult& result);

}  // namespace furrow::load
