// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/load/load_setup.h"
#include "client/load/compare/comparison.h"

namespace furrow::bench {

// A daemon compared with raw UDP echo servers at one rate.
struct ColdRow {
  std::string way;    // how the daemon runs: "plain", "secure", "busy polling"
  std::string cores;  // "one each" or "any"
  double rate = 0.0;  // poses per second
  load::Comparison comparison;
};

// The daemon beside a raw echo at rates at which it sleeps between two poses, so that its code and
// data are cold, and at 50,000 poses per second: plain, sealed and with busy polling, on a core of
// its own. Plain also where the system puts it. At most five rounds of one second.
[[nodiscard]] std::vector<ColdRow> MeasureCold(const LoadSetup& setting);

[[nodiscard]] std::string ToMarkdown(const std::vector<ColdRow>& rows);
[[nodiscard]] nlohmann::json ToJson(const std::vector<ColdRow>& rows);

}  // namespace furrow::bench
