// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/load/setting.h"

namespace furrow::bench {

// One line of the table of what is aimed at: a ratio or a number beside its limit.
struct Aim {
  std::string what;
  std::string baseline;  // what it is measured against, as measured; empty: nothing
  std::string reached;
  std::string control;  // the baseline against itself; empty: there is none
  std::string aim;
  bool met = false;
};

// Latency at 10,000 poses a second, processor time at 50,000, the highest rate without loss, 1,000
// subjects at 60 Hz, stalled subscribers, and memory at rest: the daemon beside raw UDP echoes on
// the same core, runs in turn.
[[nodiscard]] std::vector<Aim> MeasureAims(const Setting& setting);

[[nodiscard]] std::string ToMarkdown(const std::vector<Aim>& aims);
[[nodiscard]] nlohmann::json ToJson(const std::vector<Aim>& aims);

}  // namespace furrow::bench
