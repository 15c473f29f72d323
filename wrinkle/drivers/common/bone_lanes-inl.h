// SPDX-License-Identifier: Apache-2.0
// Computes the bones and the bend of hinge and ball drivers (thesis 4.6), one driver per SIMD lane.
#if defined(FURROW_WRINKLE_BONE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_BONE_LANES_INL_H_
#undef FURROW_WRINKLE_BONE_LANES_INL_H_
#else
#define FURROW_WRINKLE_BONE_LANES_INL_H_
#endif

#include "wrinkle/drivers/common/bone_pair.h"
#include "wrinkle/simd/lane_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// A unit vector per lane. A vector without length gives zero and clears `has_length`.
struct LaneDirection {
  Float3 unit;
  Mask has_length;
};
HWY_INLINE LaneDirection DirectionOf(Float3 v) {
  const Float length = hn::Sqrt(Dot(v, v));
  // The squares of long vectors overflow to infinity. Such vectors count as without length, because
  // their quotient would be 0 and not a unit vector.
  const Float infinity = hn::Inf(Floats());
  const auto has_length = hn::And(hn::Gt(length, Splat(kLeastLength)), hn::Lt(length, infinity));
  const Float3 unit = v / Float3{length, length, length};
  return {{hn::IfThenElseZero(has_length, unit.x), hn::IfThenElseZero(has_length, unit.y),
           hn::IfThenElseZero(has_length, unit.z)},
          has_length};
}

// Unit directions of the upper bone (parent's origin to joint's origin) and the lower bone (joint's
// origin to its end), in the parent's space.
struct BoneLanes {
  LaneDirection upper, lower;
};
template <bool kScaled>
HWY_INLINE BoneLanes EvaluateBones(const PointPlan& plan, const BoneBlock& block,
                                   LanePose<kScaled> pose, std::size_t lane) {
  const Float3 joint = EvaluatePoint(plan, plan.points[block.joint_point], pose, lane);
  const Float3 end = EvaluatePoint(plan, plan.points[block.end_point], pose, lane);
  return {DirectionOf(joint), DirectionOf(end - joint)};
}

// How far a joint is bent in the range from `start`, clamp((start - cosine) * scale, 0, 1).
// `cosine`: between the directions of its bones, 1 if it is straight. With start 1 and
// BendScale(beta) this is thesis 4.6: fully flexed, at cos(180 - beta), gives 1.
HWY_INLINE Float Bend(Float cosine, Float start, Float scale) {
  return Saturate(hn::Mul(hn::Sub(start, cosine), scale));
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
