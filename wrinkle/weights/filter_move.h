// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "wrinkle/solver/solver.h"

namespace furrow::wrinkle {

// What an input does to a filter (FilterJob), for one subject and for many. Private to wrinkle/.
enum class FilterMove {
  kStay,    // at the same time as the last one: nothing
  kStart,   // passes as it is
  kFollow,  // is filtered
};

[[nodiscard]] inline FilterMove MoveOn(const Filter& filter, const FilterContext& context,
                                       double dt) {
  constexpr double kLeastStep = 1e-6;  // seconds; closer inputs count as simultaneous
  if (!context.started || !filter.enabled) return FilterMove::kStart;
  return dt >= kLeastStep ? FilterMove::kFollow : FilterMove::kStay;
}

}  // namespace furrow::wrinkle
