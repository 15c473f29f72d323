// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "wrinkle/rig/rig.h"
#include "wrinkle/simd/lane_rows.h"

namespace furrow::wrinkle {

// The state of one subject's filter. Its owner sizes it once; the lists are whole rows.
struct FilterContext {
  RowList value;             // last output, [0, 1]
  RowList raw;               // last input
  RowList derivative;        // low-passed, 1/s
  double since_input = 0.0;  // seconds since the last input
  bool started = false;

  void Resize(std::size_t num_values);
  void Reset();  // restores the state after Resize(): the next input passes unchanged
};

// Rows of scratch memory that the filter needs per row of values.
inline constexpr std::size_t kFilterRows = 3;

// How the filter treats an input. filter_lanes-inl.h carries it out.
enum class FilterMove {
  kStay,    // at the time of the last input: the filter does not change
  kStart,   // the first input, or a disabled filter: the input passes unchanged
  kFollow,  // One-Euro and the slew limit
};
// How the filter treats the input `dt` seconds after the last one.
[[nodiscard]] FilterMove MoveOn(const Filter& filter, const FilterContext& context, double dt);

// Advances the filter by `dt` seconds (finite, >= 0) without input: holds for Filter::hold_seconds,
// then decays to 0 with the time constant Filter::decay_seconds, under the slew limit. Values below
// 1e-5 become 0. Works for disabled filters too. Does nothing before the first input.
void HoldAndDecay(const Filter& filter, double dt, FilterContext* context);

}  // namespace furrow::wrinkle
