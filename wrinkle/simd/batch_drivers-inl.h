// SPDX-License-Identifier: Apache-2.0
// Drivers of one subject, many of a kind side by side: the formulas of hinge.h, ball.h, twist.h
// and of blend shapes, lane by lane. Each writes its values to rows, from `lane` on.
#if defined(FURROW_WRINKLE_BATCH_DRIVERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_BATCH_DRIVERS_INL_H_
#undef FURROW_WRINKLE_BATCH_DRIVERS_INL_H_
#else
#define FURROW_WRINKLE_BATCH_DRIVERS_INL_H_
#endif

#include "wrinkle/drivers/ball/ball.h"
#include "wrinkle/drivers/bind_context.h"
#include "wrinkle/drivers/hinge/hinge.h"
#include "wrinkle/simd/batch_math-inl.h"
#include "wrinkle/simd/batch_points-inl.h"
#include "wrinkle/skeleton/twist.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// A unit vector; zero, as is `has_length`, where `v` has no length.
struct LaneDirection {
  Float3 unit;
  Mask has_length;
};
HWY_INLINE LaneDirection Direction(Float3 v) {
  const Float length = hn::Sqrt(Dot(v, v));
  const Float infinity = hn::Inf(Floats());
  const auto has_length = hn::And(hn::Gt(length, Splat(kLeastLength)), hn::Lt(length, infinity));
  const Float3 unit = v / Float3{length, length, length};
  return {{hn::IfThenElseZero(has_length, unit.x), hn::IfThenElseZero(has_length, unit.y),
           hn::IfThenElseZero(has_length, unit.z)},
          has_length};
}

// Upper and lower bone of a hinge or ball (BonePair).
struct BoneLanes {
  LaneDirection upper, lower;
};
template <bool kScaled>
HWY_INLINE BoneLanes EvaluateBones(const LanePlan& plan, const BoneBlock& block,
                                   LanePose<kScaled> pose, std::size_t lane) {
  const Float3 joint = EvaluatePoint(plan, plan.points[block.joint_point], pose, lane);
  const Float3 end = EvaluatePoint(plan, plan.points[block.end_point], pose, lane);
  return {Direction(joint), Direction(end - joint)};
}

HWY_INLINE Float LaneBend(Float cosine, Float bend_scale) {
  return Saturate(hn::Mul(hn::Sub(Splat(1.0f), cosine), bend_scale));
}

template <bool kScaled>
void Evaluate(const LanePlan& plan, const HingeBlock& block, LanePose<kScaled> pose,
              std::size_t lane, float* values) {
  const BoneLanes bones = EvaluateBones(plan, block, pose, lane);
  const Float3& upper = bones.upper.unit;
  const Float3& lower = bones.lower.unit;
  const Float bend = LaneBend(Dot(upper, lower), LoadRow(block.bend_scale, lane));
  const Float3 normal = Cross(upper, lower);
  const Float sine = hn::Sqrt(Dot(normal, normal));
  const Float along = hn::Div(Dot(normal, LoadRows(block.axis, lane)), sine);
  const Float share = Smoothstep(0.0f, kFullAlongAxis, along);
  const Mask is_signed = hn::And(LoadMask(block.has_axis, lane), hn::Gt(sine, Splat(kLeastSine)));
  const Float turned = hn::IfThenElse(is_signed, hn::Mul(bend, share), bend);
  const Float flexed =
      hn::IfThenElseZero(hn::And(bones.upper.has_length, bones.lower.has_length), turned);
  StoreLanes(flexed, values);
  StoreLanes(hn::Sub(Splat(1.0f), flexed), values + kRowLanes);
}

// SplitBend(): front, back, left, right.
inline void StoreShares(BallMode mode, Float bend, Float forward, Float right, float* values) {
  const Floats d;
  const Float zero = hn::Zero(d);
  const Float length = hn::Sqrt(hn::Add(hn::Mul(forward, forward), hn::Mul(right, right)));
  const auto has_length = hn::Gt(length, Splat(kLeastProjection));
  const Float share = hn::IfThenElseZero(has_length, bend);
  const Float cosine = hn::IfThenElseZero(has_length, hn::Div(forward, length));
  const Float sine = hn::IfThenElseZero(has_length, hn::Div(right, length));
  if (mode == BallMode::kSmooth) {
    const Float directions[4] = {cosine, hn::Neg(cosine), hn::Neg(sine), sine};
    for (std::size_t i = 0; i < 4; ++i) {
      const Float positive = hn::Max(directions[i], zero);
      StoreLanes(hn::Mul(share, hn::Mul(positive, positive)), values + i * kRowLanes);
    }
    return;
  }
  const Float threshold = Splat(kThesisThreshold);
  const Float beside = hn::IfThenElseZero(hn::Lt(hn::Abs(cosine), threshold), share);
  const auto is_left = hn::Lt(sine, zero);
  StoreLanes(hn::IfThenElseZero(hn::Gt(cosine, threshold), share), values);
  StoreLanes(hn::IfThenElseZero(hn::Lt(cosine, hn::Neg(threshold)), share), values + kRowLanes);
  StoreLanes(hn::IfThenElseZero(is_left, beside), values + 2 * kRowLanes);
  StoreLanes(hn::IfThenZeroElse(is_left, beside), values + 3 * kRowLanes);
}

template <bool kScaled>
void Evaluate(const LanePlan& plan, const BallBlock& block, LanePose<kScaled> pose,
              std::size_t lane, float* values) {
  const BoneLanes bones = EvaluateBones(plan, block, pose, lane);
  const Mask fixed = LoadMask(block.has_straight, lane);
  const Float3 straight = IfThenElse(fixed, LoadRows(block.straight, lane), bones.upper.unit);
  const Float3& lower = bones.lower.unit;
  const Float cosine = Dot(straight, lower);
  const Float3 across = lower - cosine * straight;
  const Mask counts = hn::And(bones.lower.has_length, hn::Or(fixed, bones.upper.has_length));
  const Float bend = hn::IfThenElseZero(counts, LaneBend(cosine, LoadRow(block.bend_scale, lane)));
  StoreShares(block.mode, bend, Dot(across, LoadRows(block.forward, lane)),
              Dot(across, LoadRows(block.right, lane)), values);
}

HWY_INLINE FloatQuat Multiply(FloatQuat p, FloatQuat q) {
  const auto sum = [](Float a, Float b, Float c, Float e)
                       HWY_ATTR { return hn::Sub(hn::Add(hn::Add(a, b), c), e); };
  return {sum(hn::Mul(p.w, q.x), hn::Mul(p.x, q.w), hn::Mul(p.y, q.z), hn::Mul(p.z, q.y)),
          sum(hn::Mul(p.w, q.y), hn::Mul(p.y, q.w), hn::Mul(p.z, q.x), hn::Mul(p.x, q.z)),
          sum(hn::Mul(p.w, q.z), hn::Mul(p.z, q.w), hn::Mul(p.x, q.y), hn::Mul(p.y, q.x)),
          hn::Sub(hn::Sub(hn::Sub(hn::Mul(p.w, q.w), hn::Mul(p.x, q.x)), hn::Mul(p.y, q.y)),
                  hn::Mul(p.z, q.z))};
}

// TwistAngle().
HWY_INLINE Float LaneTwist(FloatQuat q, Float3 axis) {
  const Float sine = Dot({q.x, q.y, q.z}, axis);
  const Float square = hn::Add(hn::Mul(sine, sine), hn::Mul(q.w, q.w));
  const auto turned = hn::Lt(q.w, hn::Zero(Floats()));
  const Float angle = ArcTangent(hn::IfThenElse(turned, hn::Neg(sine), sine), hn::Abs(q.w));
  return hn::IfThenElseZero(hn::Gt(square, Splat(kLeastTwistSquare)), hn::Add(angle, angle));
}

template <bool kScaled>
void Evaluate(const LanePlan& plan, const TwistBlock& block, LanePose<kScaled> pose,
              std::size_t lane, float* values) {
  Float sum = hn::Zero(Floats());
  for (std::uint32_t i = 0; i < block.num_steps; ++i) {
    const TwistStep& step = plan.twist_steps[block.first_step + i];
    const Float3 r = LoadRows(step.rest_inverse, lane);
    const FloatQuat rest_inverse{r.x, r.y, r.z, LoadRow(step.rest_inverse[3], lane)};
    const FloatQuat rotation = LoadRotation(pose.numbers, step.joint.joints.at + lane);
    const Float angle = LaneTwist(Multiply(rest_inverse, rotation), LoadRows(step.axis, lane));
    sum = hn::Add(sum, hn::IfThenElseZero(LoadMask(step.joint.active, lane), angle));
  }
  const Float share = hn::Mul(sum, LoadRow(block.inverse_full, lane));
  StoreLanes(Saturate(share), values);
  StoreLanes(Saturate(hn::Neg(share)), values + kRowLanes);
}

inline void Evaluate(const BlendShapeBlock& block, std::span<const float> blend_shapes,
                     std::size_t lane, float* values) {
  HWY_ALIGN float coefficients[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) {
    const auto index = static_cast<std::size_t>(block.blend_shape.at[lane + i]);
    coefficients[i] = index < blend_shapes.size() ? blend_shapes[index] : 0.0f;
  }
  const Float above = hn::Sub(LoadLanes(coefficients), LoadRow(block.neutral, lane));
  StoreLanes(Saturate(hn::Div(above, LoadRow(block.range, lane))), values);
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
