// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "wrinkle/simd/lane_rows.h"
#include "wrinkle/weights/modulation_curve.h"

namespace furrow::wrinkle {

// One piece of the curves of sixteen lanes (CurvePiece).
struct CurveRow {
  FloatRow from;
  FloatRow c[4];
};

// The modulation of sixteen values, one per lane (4.3, 4.4, curves). weight_lanes-inl.h carries it
// out. Private to wrinkle/.
struct ModulationRow {
  IntRow is_cosine;  // -1 or 0; a lane without any of the three is linear
  IntRow is_cubic;
  IntRow is_curve;
  std::vector<CurveRow> curve;  // piece by piece; empty if no lane has a curve
  bool all_cosine = true;       // of the lanes set
  bool any_cubic = false;

  void Set(const FeedModulation& modulation, std::size_t lane);
};

// Modulates a row of values in [0, 1], in place. The row is aligned (kRowAlignment).
using ModulateRow = void(const ModulationRow& modulation, float* row);

}  // namespace furrow::wrinkle
