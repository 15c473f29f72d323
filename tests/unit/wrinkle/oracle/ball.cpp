// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/oracle/ball.h"

#include <algorithm>
#include <cmath>

namespace furrow::wrinkle {
namespace {

float SquareOfPositive(float x) {
  const float positive = std::max(x, 0.0f);
  return positive * positive;
}

BallShares SplitSmooth(float bend, float cos_psi, float sin_psi) {
  return {.front = bend * SquareOfPositive(cos_psi),
          .back = bend * SquareOfPositive(-cos_psi),
          .left = bend * SquareOfPositive(-sin_psi),
          .right = bend * SquareOfPositive(sin_psi)};
}

BallShares SplitThesis(float bend, float phi, float gamma) {
  BallShares shares;
  if (phi > kThesisThreshold) {
    shares.front = bend;
  } else if (phi < -kThesisThreshold) {
    shares.back = bend;
  } else if (std::abs(phi) < kThesisThreshold) {
    (gamma < 0.0f ? shares.left : shares.right) = bend;
  }
  return shares;
}

}  // namespace

BallShares SplitBend(BallMode mode, float bend, float forward, float right) {
  const float length = std::hypot(forward, right);
  if (!(length > kLeastProjection)) return {};
  const float cos_psi = forward / length;
  const float sin_psi = right / length;
  return mode == BallMode::kThesis ? SplitThesis(bend, cos_psi, sin_psi)
                                   : SplitSmooth(bend, cos_psi, sin_psi);
}

}  // namespace furrow::wrinkle
