// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "client/load/compare/comparison.h"

namespace furrow::load {

// A Markdown table of the figures, the highest rate, and remarks about anything that limits what
// they mean.
[[nodiscard]] std::string ToText(const Comparison& comparison);
[[nodiscard]] nlohmann::json ToJson(const Comparison& comparison);

}  // namespace furrow::load
