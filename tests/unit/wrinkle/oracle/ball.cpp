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

BallShares SplitWideBend(BallMode mode, float bend, float cosine, float forward, float right,
                         const glm::vec2& rest_side) {
  if (mode == BallMode::kThesis || cosine >= 0.0f) return SplitBend(mode, bend, forward, right);
  double turn = 0.0;
  if (cosine < -0.5f) turn = 8.0 * std::pow(double{cosine} + 0.5, 2.0);
  const double turned_forward = forward + turn * rest_side.x;
  const double turned_right = right + turn * rest_side.y;
  const double t = std::min(std::hypot(turned_forward, turned_right) / 0.5, 1.0);
  const double fade = 3.0 * t * t - 2.0 * t * t * t;
  return SplitBend(mode, static_cast<float>(bend * fade), static_cast<float>(turned_forward),
                   static_cast<float>(turned_right));
}

}  // namespace furrow::wrinkle
