// SPDX-License-Identifier: Apache-2.0
// Evaluates ball drivers, one driver per SIMD lane: how far the joint is bent (thesis 4.6), split
// by direction (docs/ALGORITHM.md).
#if defined(FURROW_WRINKLE_BALL_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_BALL_LANES_INL_H_
#undef FURROW_WRINKLE_BALL_LANES_INL_H_
#else
#define FURROW_WRINKLE_BALL_LANES_INL_H_
#endif

#include "wrinkle/drivers/ball/ball_driver.h"
#include "wrinkle/drivers/common/bone_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// The lower bone's projection onto the plane across the straight direction, and its length. Only
// its angle psi = atan2(right, forward) counts.
struct BendSide {
  Float forward, right, length;
};
HWY_INLINE BendSide SideOf(Float forward, Float right) {
  const Float square = hn::Add(hn::Mul(forward, forward), hn::Mul(right, right));
  return {forward, right, hn::Sqrt(square)};
}

// BallMode::kSmooth: far from straight, turns the direction towards the side of the rest direction.
// `cosine` is that of the bend.
HWY_INLINE BendSide TurnToRest(BendSide side, Float cosine, const BallBlock& block,
                               std::size_t lane) {
  const Float beyond = hn::Max(hn::Sub(Splat(kTurnCosine), cosine), hn::Zero(Floats()));
  const Float turn = hn::Mul(hn::Mul(Splat(kTurnGain), beyond), beyond);
  return SideOf(hn::Add(side.forward, hn::Mul(turn, LoadRow(block.rest_side[0], lane))),
                hn::Add(side.right, hn::Mul(turn, LoadRow(block.rest_side[1], lane))));
}

// The factor of BallMode::kSmooth around the singular direction, in the half away from straight: a
// smoothstep of the length up to kFadeLength.
HWY_INLINE Float Fade(Float length, Float cosine) {
  const Float smooth = Smoothstep(0.0f, kFadeLength, length);
  return hn::IfThenElse(hn::Lt(cosine, hn::Zero(Floats())), smooth, Splat(1.0f));
}

// How far the joint is bent in the range of each direction, in [0, 1].
struct Bends {
  Float front, back, left, right;
};

// Stores the shares of the bends to front, back, left and right in four rows from `values` on. All
// shares are 0 if the projection is shorter than kLeastProjection.
//
// - kSmooth: the bends times the squares of the positive parts of cos(psi), -cos(psi), -sin(psi)
//   and sin(psi). If all ranges are equal they sum to the bend. They are C1 in psi.
// - kThesis: the whole bend goes to front if cos(psi) > 0.75, to back if < -0.75, and to left or
//   right between them. At exactly +-0.75 the thesis states no case: all shares are 0.
inline void StoreShares(BallMode mode, const Bends& bends, const BendSide& side, float* values) {
  const Floats d;
  const Float zero = hn::Zero(d);
  const auto has_length = hn::Gt(side.length, Splat(kLeastProjection));
  const Float shares[4] = {
      hn::IfThenElseZero(has_length, bends.front), hn::IfThenElseZero(has_length, bends.back),
      hn::IfThenElseZero(has_length, bends.left), hn::IfThenElseZero(has_length, bends.right)};
  const Float cosine = hn::IfThenElseZero(has_length, hn::Div(side.forward, side.length));
  const Float sine = hn::IfThenElseZero(has_length, hn::Div(side.right, side.length));
  if (mode == BallMode::kSmooth) {
    const Float directions[4] = {cosine, hn::Neg(cosine), hn::Neg(sine), sine};
    for (std::size_t i = 0; i < 4; ++i) {
      const Float positive = hn::Max(directions[i], zero);
      StoreLanes(hn::Mul(shares[i], hn::Mul(positive, positive)), values + i * kRowLanes);
    }
    return;
  }
  const Float threshold = Splat(kThesisThreshold);
  const auto beside = hn::Lt(hn::Abs(cosine), threshold);
  const auto is_left = hn::And(beside, hn::Lt(sine, zero));
  const auto is_right = hn::And(beside, hn::Ge(sine, zero));
  const Mask chosen[4] = {hn::Gt(cosine, threshold), hn::Lt(cosine, hn::Neg(threshold)), is_left,
                          is_right};
  for (std::size_t i = 0; i < 4; ++i) {
    StoreLanes(hn::IfThenElseZero(chosen[i], shares[i]), values + i * kRowLanes);
  }
}

// Writes the four values of each driver of `drivers` to the scratch memory `rows` (kRowLanes floats
// per row): row b.first_row + i of block b holds value i (StoreShares()), lane l that of its driver
// l. The straight direction is the stated one, or that of the upper bone. Values are 0 if a bone
// that counts has no length.
template <bool kScaled>
void EvaluateDrivers(const BallDriverSet& drivers, const PointPlan& plan, LanePose<kScaled> pose,
                     const DriverInput& input, float* rows) {
  const auto evaluate = [&](const BallBlock& block, std::size_t lane, float* to) HWY_ATTR {
    const BoneLanes bones = EvaluateBones(plan, block, pose, lane);
    const Mask fixed = LoadMask(block.has_straight, lane);
    // Lanes with and without a stated bone share a block; each lane selects its own.
    const Float3 straight = IfThenElse(fixed, LoadRows(block.straight, lane), bones.upper.unit);
    const Float3& lower = bones.lower.unit;
    const Float cosine = Dot(straight, lower);
    const Float3 across = lower - cosine * straight;
    const Mask counts = hn::And(bones.lower.has_length, hn::Or(fixed, bones.upper.has_length));
    BendSide side = SideOf(Dot(across, LoadRows(block.forward, lane)),
                           Dot(across, LoadRows(block.right, lane)));
    Float factor = hn::IfThenElseZero(counts, Splat(1.0f));
    if (block.mode == BallMode::kSmooth) {
      side = TurnToRest(side, cosine, block, lane);
      factor = hn::Mul(factor, Fade(side.length, cosine));
    }
    const auto bend = [&](std::size_t i) HWY_ATTR {
      const Float start = LoadRow(block.start[i], lane);
      return hn::Mul(Bend(cosine, start, LoadRow(block.scale[i], lane)), factor);
    };
    StoreShares(block.mode, {bend(0), bend(1), bend(2), bend(3)}, side, to);
  };
  ForEachBlock(drivers.blocks(), input.num_values, rows, evaluate);
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
