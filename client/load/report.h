// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "client/load/run.h"

namespace furrow::load {

// What a search tried: how a server took one rate.
struct RateStep {
  double rate = 0.0;  // poses a second
  double p50_us = 0.0;
  double p99_us = 0.0;
  double lost_share = 0.0;
  bool held = false;
  bool generator_behind = false;  // not held, and this program was too slow itself
};

// One line about a run that is under way.
[[nodiscard]] std::string LiveLine(double seconds, const Tally& tally, const Histogram& latency_ns);

// Tables for people: what was sent and came back, how long it took, what the server used, and
// sentences about what spoils the measurement.
[[nodiscard]] std::string ToText(const RunResult& result, const RunOptions& options);

[[nodiscard]] nlohmann::json ToJson(const RunResult& result);

// Latency by percentile and over time where something came back, and where there are steps, latency
// and loss by rate: an SVG picture.
[[nodiscard]] std::string Plot(const RunResult& result, const std::vector<RateStep>& steps);

}  // namespace furrow::load
