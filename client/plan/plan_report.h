// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "client/plan/capacity.h"

namespace furrow::plan {

// The plan for people, as Markdown: the demand, its costs, the machines, and where the figures come
// from.
[[nodiscard]] std::string ToText(const Capacity& plan, const Demand& demand, const Machine& machine,
                                 const Costs& costs);

// The same figures for programs. The names are part of the format.
[[nodiscard]] nlohmann::json ToJson(const Capacity& plan, const Demand& demand,
                                    const Machine& machine);

}  // namespace furrow::plan
