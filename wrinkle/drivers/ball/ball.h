// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "wrinkle/rig/rig.h"

namespace furrow::wrinkle {

inline constexpr float kLeastProjection = 1e-6f;  // shorter ones have no direction
inline constexpr float kThesisThreshold = 0.75f;

// Shares of a ball joint's bend by direction, each in [0, 1]; left and right are the subject's.
struct BallShares {
  float front = 0.0f;
  float back = 0.0f;
  float left = 0.0f;
  float right = 0.0f;
};

// Splits `bend` (Bend() of the two bones) by where the lower bone points.
//
// - `forward`, `right`: the lower bone projected across the straight direction; any length, since
//   only psi = atan2(right, forward) counts. All shares are 0 where the projection has no length.
// - kSmooth: bend times the squares of the positive parts of cos(psi), -cos(psi), sin(psi) and
//   -sin(psi). They sum to `bend` and are C1 in psi.
// - kThesis: all of it to front where cos(psi) > 0.75, to back where
//   < -0.75, and between them to left or right. Jumps at psi = 41.4
//   degrees; at exactly +-0.75 the thesis states no case: all are 0.
[[nodiscard]] BallShares SplitBend(BallMode mode, float bend, float forward, float right);

}  // namespace furrow::wrinkle
