// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "wrinkle/rig/rig.h"

namespace furrow::wrinkle {

// How one map of a region shapes its combined value: by a curve if it has points, otherwise by a
// named modulation.
struct FeedModulation {
  Modulation modulation = Modulation::kCosine;
  std::vector<CurvePoint> curve = {};
};

// The feed's own modulation or curve; if it has neither, the region's. A curve over angles becomes
// a curve over the combined value: each of its points lies at the first source's value at that
// angle, times its gain.
[[nodiscard]] FeedModulation ModulationOf(const Rig& rig, const Region& region, const Feed& feed);

// "linear", "cosine", "cubic", or "curve".
[[nodiscard]] std::string_view ModulationName(const FeedModulation& modulation);

// One piece of a curve, from x = `from` to the next piece: with t = x - from,
// y = c[0] + c[1] t + c[2] t^2 + c[3] t^3.
struct CurvePiece {
  float from = 0.0f;
  float c[4] = {};
};

// The pieces of a curve over [0, 1]: the first begins at 0, the others at the points. At most
// kMaxCurvePoints + 1 (rig_check.h).
//
// - The curve is the monotone cubic through the points (PCHIP: Fritsch and Butland, A Method for
//   Constructing Local Monotone Piecewise Cubic Interpolants, 1984; MATLAB's pchip, SciPy's
//   PchipInterpolator). Its slope is continuous. Between two points it rises or falls without
//   overshoot, so it stays in [0, 1]. Through two points it is the line.
// - Before the first point and after the last, it is constant.
// - Precondition: the points pass CheckRigFields().
[[nodiscard]] std::vector<CurvePiece> CurvePieces(std::span<const CurvePoint> points);

}  // namespace furrow::wrinkle
