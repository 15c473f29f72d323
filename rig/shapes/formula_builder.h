// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "rig/shapes/shape_map.h"
#include "wrinkle/shapes/shape_formula.h"

namespace furrow::rig {

// The numbers that a formula of a map may read, by the index of the shape; nullopt: missing.
using ShapeInputs = std::vector<std::optional<wrinkle::ShapeInput>>;

// A formula of a map with its shapes found.
struct BuiltFormula {
  wrinkle::ShapeFormula formula;
  bool renames = false;   // equals one input
  bool fallback = false;  // a later alternative, or a mean without some of its terms
};

// Builds the first of `formulas` that has all its inputs, or else the one with the most terms.
// nullopt: no term has its inputs. `only_complete`: formulas with missing terms do not count.
[[nodiscard]] std::optional<BuiltFormula> BuildFormula(std::span<const MapFormula> formulas,
                                                       const ShapeInputs& inputs,
                                                       bool only_complete = false);

}  // namespace furrow::rig
