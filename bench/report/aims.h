// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/status.h"

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

// "1.05 (1.01 to 1.12)": a median, and between what the middle half lies.
[[nodiscard]] std::string Between(double median, double low, double high, int digits);

// `control`: the heading of that column; empty: there is none.
[[nodiscard]] std::string ToMarkdown(
    const std::vector<Aim>& aims, const std::string& control,
    const std::string& title = "What was aimed at, and what was reached");
[[nodiscard]] nlohmann::json ToJson(const std::vector<Aim>& aims);
// What ToJson() made. Errors: kInvalidArgument.
[[nodiscard]] Result<std::vector<Aim>> AimsFromJson(const nlohmann::json& json);

}  // namespace furrow::bench
