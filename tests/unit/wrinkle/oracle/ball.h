// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "wrinkle/drivers/ball/ball_driver.h"

namespace furrow::wrinkle {

// Shares of a ball joint's bend by direction, each in [0, 1]; left and right are the subject's.
struct BallShares {
  float front = 0.0f;
  float back = 0.0f;
  float left = 0.0f;
  float right = 0.0f;
};

// Splits `bend` (Bend() of the two bones) by the direction of the lower bone.
//
// - `forward`, `right`: the lower bone projected across the straight direction. Only psi =
//   atan2(right, forward) counts. All shares are 0 if the projection has no length.
// - kSmooth: bend times the squares of the positive parts of cos(psi), -cos(psi), sin(psi) and
//   -sin(psi). They sum to `bend` and are C1 in psi.
// - kThesis: all of it to front where cos(psi) > 0.75, to back where
//   < -0.75, and between them to left or right. Jumps at psi = 41.4
//   degrees; at exactly +-0.75 the thesis states no case: all are 0.
[[nodiscard]] BallShares SplitBend(BallMode mode, float bend, float forward, float right);

// SplitBend() for a bend of any angle, as the driver computes it.
//
// - `cosine`: of the angle between the straight direction and the lower bone.
// - `rest_side`: BallDriverSet::Entry::rest_side. kSmooth turns directions beyond 120 degrees
//   towards it, and fades around the direction that is then singular.
[[nodiscard]] BallShares SplitWideBend(BallMode mode, float bend, float cosine, float forward,
                                       float right, const glm::vec2& rest_side);

}  // namespace furrow::wrinkle
