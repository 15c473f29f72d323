// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/status.h"

namespace furrow::bench {

// One row of the table of performance aims: a measured figure and its limit.
struct Aim {
  std::string what;
  std::string baseline;  // the measured baseline; empty if there is none
  std::string reached;
  std::string control;  // the baseline compared with itself; empty if there is none
  std::string aim;
  bool met = false;
};

// Formats a median and its interquartile range: "1.05 (1.01 to 1.12)".
[[nodiscard]] std::string Between(double median, double low, double high, int digits);

// `control` is the heading of the control column; empty for no such column.
[[nodiscard]] std::string ToMarkdown(const std::vector<Aim>& aims, const std::string& control,
                                     const std::string& title = "Aims and results");
[[nodiscard]] nlohmann::json ToJson(const std::vector<Aim>& aims);
// Reads the result of ToJson(). Errors: kInvalidArgument.
[[nodiscard]] Result<std::vector<Aim>> AimsFromJson(const nlohmann::json& json);

}  // namespace furrow::bench
