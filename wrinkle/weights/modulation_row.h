// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "wrinkle/rig/rig.h"
#include "wrinkle/simd/lane_rows.h"

namespace furrow::wrinkle {

// The modulation of sixteen values, one per lane (4.3, 4.4). weight_lanes-inl.h carries it out.
// Private to wrinkle/.
struct ModulationRow {
  IntRow is_cosine;  // -1 or 0; a lane that is neither cosine nor cubic is linear
  IntRow is_cubic;
  bool all_cosine = true;  // of the lanes set
  bool any_cubic = false;

  void Set(Modulation modulation, std::size_t lane) {
    is_cosine.at[lane] = modulation == Modulation::kCosine ? -1 : 0;
    is_cubic.at[lane] = modulation == Modulation::kCubic ? -1 : 0;
    all_cosine = all_cosine && modulation == Modulation::kCosine;
    any_cubic = any_cubic || modulation == Modulation::kCubic;
  }
};

// Modulates a row of values in [0, 1], in place. The row is aligned (kRowAlignment).
using ModulateRow = void(const ModulationRow& modulation, float* row);

}  // namespace furrow::wrinkle
