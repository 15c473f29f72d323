// SPDX-License-Identifier: Apache-2.0
// Evaluates twist drivers, one driver per SIMD lane: the sum of the joints' twists away from rest.
#if defined(FURROW_WRINKLE_TWIST_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_TWIST_LANES_INL_H_
#undef FURROW_WRINKLE_TWIST_LANES_INL_H_
#else
#define FURROW_WRINKLE_TWIST_LANES_INL_H_
#endif

#include "wrinkle/drivers/twist/twist_driver.h"
#include "wrinkle/simd/lane_math-inl.h"
#include "wrinkle/simd/lane_points-inl.h"
#include "wrinkle/skeleton/twist.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// The product p q in glm's order of operations and without fused sums, like the operations in
// lanes-inl.h.
HWY_INLINE FloatQuat Multiply(FloatQuat p, FloatQuat q) {
  const auto sum = [](Float a, Float b, Float c, Float e)
                       HWY_ATTR { return hn::Sub(hn::Add(hn::Add(a, b), c), e); };
  return {sum(hn::Mul(p.w, q.x), hn::Mul(p.x, q.w), hn::Mul(p.y, q.z), hn::Mul(p.z, q.y)),
          sum(hn::Mul(p.w, q.y), hn::Mul(p.y, q.w), hn::Mul(p.z, q.x), hn::Mul(p.x, q.z)),
          sum(hn::Mul(p.w, q.z), hn::Mul(p.z, q.w), hn::Mul(p.x, q.y), hn::Mul(p.y, q.x)),
          hn::Sub(hn::Sub(hn::Sub(hn::Mul(p.w, q.w), hn::Mul(p.x, q.x)), hn::Mul(p.y, q.y)),
                  hn::Mul(p.z, q.z))};
}

// The angle in radians by which the unit quaternion `q` turns about the unit vector `axis`:
// TwistAngle() (skeleton/twist.h) per lane. q and -q are the same rotation. The one with a w of 0
// or more has the shorter turn, and ArcTangent() requires it.
HWY_INLINE Float TwistOf(FloatQuat q, Float3 axis) {
  const Float sine = Dot({q.x, q.y, q.z}, axis);
  const Float square = hn::Add(hn::Mul(sine, sine), hn::Mul(q.w, q.w));
  const auto turned = hn::Lt(q.w, hn::Zero(Floats()));
  const Float angle = ArcTangent(hn::IfThenElse(turned, hn::Neg(sine), sine), hn::Abs(q.w));
  return hn::IfThenElseZero(hn::Gt(square, Splat(kLeastTwistSquare)), hn::Add(angle, angle));
}

// Writes the values of each driver of `drivers` to the scratch memory `rows` (kRowLanes floats per
// row), lane l for driver l of block b: row b.first_row is clamp(s, 0, 1) and the next row
// clamp(-s, 0, 1), with s = (sum of twist angles) / (angle of a full twist). The points are unused
// because twists need rotations only.
template <bool kScaled>
void EvaluateDrivers(const TwistDriverSet& drivers, const PointPlan&, LanePose<kScaled> pose,
                     const DriverInput& input, float* rows) {
  const auto evaluate = [&](const TwistBlock& block, std::size_t lane, float* to) HWY_ATTR {
    Float sum = hn::Zero(Floats());
    for (std::uint32_t i = 0; i < block.num_steps; ++i) {
      const TwistStep& step = drivers.steps()[block.first_step + i];
      const Float3 r = LoadRows(step.rest_inverse, lane);
      const FloatQuat rest_inverse{r.x, r.y, r.z, LoadRow(step.rest_inverse[3], lane)};
      const FloatQuat rotation = LoadRotation(pose.numbers, step.joint.joints.at + lane);
      const Float angle = TwistOf(Multiply(rest_inverse, rotation), LoadRows(step.axis, lane));
      sum = hn::Add(sum, hn::IfThenElseZero(LoadMask(step.joint.active, lane), angle));
    }
    const Float share = hn::Mul(sum, LoadRow(block.inverse_full, lane));
    StoreLanes(Saturate(share), to);
    StoreLanes(Saturate(hn::Neg(share)), to + kRowLanes);
  };
  ForEachBlock(drivers.blocks(), input.num_values, rows, evaluate);
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
