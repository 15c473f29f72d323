// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "client/load/compare/comparison.h"

namespace furrow::load {

// Returns Markdown: a table of the figures, the highest rate, and remarks about anything that makes
// the figures less reliable.
[[nodiscard]] std::string ToText(const Comparison& comparison);
// Returns all measurements as a JSON object.
[[nodiscard]] nlohmann::json ToJson(const Comparison& comparison);

}  // namespace furrow::load
