// SPDX-License-Identifier: Apache-2.0
// Drivers of several subjects side by side: the formulas of pose_projection.h, hinge.h, ball.h and
// twist.h, lane by lane. Each writes its values to rows of kLanes floats.
#if defined(FURROW_WRINKLE_BATCH_DRIVERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_BATCH_DRIVERS_INL_H_
#undef FURROW_WRINKLE_BATCH_DRIVERS_INL_H_
#else
#define FURROW_WRINKLE_BATCH_DRIVERS_INL_H_
#endif

#include "wrinkle/ball.h"
#include "wrinkle/batch_lanes-inl.h"
#include "wrinkle/batch_math-inl.h"
#include "wrinkle/hinge.h"
#include "wrinkle/twist.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

struct JointLanes {
  Float3 translation;
  FloatQuat rotation;
  Float3 scale;
};

constexpr std::size_t kJointFloats = sizeof(Transform) / sizeof(float);
static_assert(kJointFloats == 10 && offsetof(Transform, rotation) == 12 &&
              offsetof(Transform, scale) == 28 && offsetof(glm::quat, x) == 0 &&
              offsetof(glm::quat, w) == 12);

HWY_INLINE Float3 LoadTranslation(const float* const* poses, int joint) {
  const Columns columns = LoadColumns(poses, static_cast<std::size_t>(joint) * kJointFloats);
  return {columns.c0, columns.c1, columns.c2};
}

HWY_INLINE JointLanes LoadJoint(const float* const* poses, int joint) {
  const std::size_t first = static_cast<std::size_t>(joint) * kJointFloats;
  const Columns begin = LoadColumns(poses, first);
  const Columns middle = LoadColumns(poses, first + 4);
  const Columns end = LoadColumns(poses, first + 6);  // so that nothing past the joint is read
  return {{begin.c0, begin.c1, begin.c2},
          {begin.c3, middle.c0, middle.c1, middle.c2},
          {middle.c3, end.c2, end.c3}};
}

HWY_INLINE FloatQuat LoadRotation(const float* const* poses, int joint) {
  const Columns columns = LoadColumns(poses, static_cast<std::size_t>(joint) * kJointFloats + 3);
  return {columns.c0, columns.c1, columns.c2, columns.c3};
}

// The poses of a group. `check` turns NaN in a lane where a number that was read is not finite (or
// where finite ones overflowed): whatever is made of such a number times 0 is no longer 0.
struct PoseLanes {
  const float* const* poses;
  Float check;

  HWY_INLINE void Check(Float3 v) {
    const Float zero = hn::Zero(Floats());
    check = hn::MulAdd(v.z, zero, hn::MulAdd(v.y, zero, hn::MulAdd(v.x, zero, check)));
  }
};

// JointChains::Evaluate(). What it reads of a pose: read_numbers.h.
HWY_INLINE Float3 EvaluatePoint(const JointChains::Chain& chain, PoseLanes* lanes) {
  const float* const* const poses = lanes->poses;
  std::span<const std::int16_t> up = chain.up;
  Float3 position = Splat(chain.offset);
  if (!up.empty() && chain.offset == glm::vec3(0.0f)) {  // a joint's origin: nothing to turn
    position = LoadTranslation(poses, up.front());
    up = up.subspan(1);
  }
  for (const std::int16_t index : up) {
    const JointLanes joint = LoadJoint(poses, index);
    position = joint.translation + Rotate(joint.rotation, joint.scale * position);
  }
  for (const std::int16_t index : chain.down) {
    const JointLanes joint = LoadJoint(poses, index);
    // Checked before the division, which makes a finite number of an infinite scale.
    const Float3 turned = Rotate(Conjugate(joint.rotation), position - joint.translation);
    lanes->Check(joint.scale);
    position = turned / joint.scale;
  }
  lanes->Check(position);
  return position;
}

// A unit vector; zero, as is `has_length`, where `v` has no length.
struct LaneDirection {
  Float3 unit;
  hn::Mask<Floats> has_length;
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
HWY_INLINE BoneLanes EvaluateBones(const BonePair& bones, const JointChains& chains,
                                   PoseLanes* lanes) {
  const Float3 joint = EvaluatePoint(chains.chain(bones.joint_point), lanes);
  const Float3 end = EvaluatePoint(chains.chain(bones.end_point), lanes);
  return {Direction(joint), Direction(end - joint)};
}

HWY_INLINE Float LaneBend(Float cosine, float bend_scale) {
  return Saturate(hn::Mul(hn::Sub(Splat(1.0f), cosine), Splat(bend_scale)));
}

inline void EvaluateHinge(const HingeDriverSet::Entry& entry, const JointChains& chains,
                          PoseLanes* lanes, float* values) {
  const BoneLanes bones = EvaluateBones(entry.bones, chains, lanes);
  const Float3& upper = bones.upper.unit;
  const Float3& lower = bones.lower.unit;
  Float flexed = LaneBend(Dot(upper, lower), entry.bend_scale);
  if (entry.axis != glm::vec3(0.0f)) {
    const Float3 normal = Cross(upper, lower);
    const Float sine = hn::Sqrt(Dot(normal, normal));
    const Float along = hn::Div(Dot(normal, Splat(entry.axis)), sine);
    const Float share = Smoothstep(0.0f, kFullAlongAxis, along);
    flexed = hn::IfThenElse(hn::Gt(sine, Splat(kLeastSine)), hn::Mul(flexed, share), flexed);
  }
  flexed = hn::IfThenElseZero(hn::And(bones.upper.has_length, bones.lower.has_length), flexed);
  StoreLanes(flexed, values);
  StoreLanes(hn::Sub(Splat(1.0f), flexed), values + kLanes);
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
      StoreLanes(hn::Mul(share, hn::Mul(positive, positive)), values + i * kLanes);
    }
    return;
  }
  const Float threshold = Splat(kThesisThreshold);
  const Float beside = hn::IfThenElseZero(hn::Lt(hn::Abs(cosine), threshold), share);
  const auto is_left = hn::Lt(sine, zero);
  StoreLanes(hn::IfThenElseZero(hn::Gt(cosine, threshold), share), values);
  StoreLanes(hn::IfThenElseZero(hn::Lt(cosine, hn::Neg(threshold)), share), values + kLanes);
  StoreLanes(hn::IfThenElseZero(is_left, beside), values + 2 * kLanes);
  StoreLanes(hn::IfThenZeroElse(is_left, beside), values + 3 * kLanes);
}

inline void EvaluateBall(const BallDriverSet::Entry& entry, const JointChains& chains,
                         PoseLanes* lanes, float* values) {
  const BoneLanes bones = EvaluateBones(entry.bones, chains, lanes);
  const bool fixed = entry.straight != glm::vec3(0.0f);
  const Float3 straight = fixed ? Splat(entry.straight) : bones.upper.unit;
  const Float3& lower = bones.lower.unit;
  const Float cosine = Dot(straight, lower);
  const Float3 across = lower - cosine * straight;
  Float bend = hn::IfThenElseZero(bones.lower.has_length, LaneBend(cosine, entry.bend_scale));
  if (!fixed) bend = hn::IfThenElseZero(bones.upper.has_length, bend);
  StoreShares(entry.mode, bend, Dot(across, Splat(entry.forward)), Dot(across, Splat(entry.right)),
              values);
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

inline void EvaluateTwist(const TwistDriverSet::Entry& entry,
                          std::span<const TwistDriverSet::TwistJoint> joints, PoseLanes* lanes,
                          float* values) {
  Float sum = hn::Zero(Floats());
  for (const TwistDriverSet::TwistJoint& joint : joints) {
    const glm::quat& r = joint.rest_inverse;
    const FloatQuat rest_inverse{Splat(r.x), Splat(r.y), Splat(r.z), Splat(r.w)};
    const FloatQuat away = Multiply(rest_inverse, LoadRotation(lanes->poses, joint.joint));
    lanes->Check({away.x, away.y, away.z});
    sum = hn::Add(sum, LaneTwist(away, Splat(joint.axis)));
  }
  const Float share = hn::Mul(sum, Splat(entry.inverse_full));
  StoreLanes(Saturate(share), values);
  StoreLanes(Saturate(hn::Neg(share)), values + kLanes);
}

inline void EvaluateBlendShape(const BlendShapeDriverSet::Entry& entry,
                               const std::span<const float>* blend_shapes, float* values) {
  const std::size_t index = static_cast<std::size_t>(entry.blend_shape);
  HWY_ALIGN float coefficients[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) {
    coefficients[i] = index < blend_shapes[i].size() ? blend_shapes[i][index] : 0.0f;
  }
  const Float above = hn::Sub(LoadLanes(coefficients), Splat(entry.neutral));
  StoreLanes(Saturate(hn::Div(above, Splat(entry.full - entry.neutral))), values);
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
