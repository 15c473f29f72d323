// SPDX-License-Identifier: Apache-2.0
// Evaluates hinge drivers, one driver per SIMD lane: how far the joint is bent (thesis 4.6), with a
// sign (docs/ALGORITHM.md).
#if defined(FURROW_WRINKLE_HINGE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_HINGE_LANES_INL_H_
#undef FURROW_WRINKLE_HINGE_LANES_INL_H_
#else
#define FURROW_WRINKLE_HINGE_LANES_INL_H_
#endif

#include "wrinkle/drivers/common/bone_lanes-inl.h"
#include "wrinkle/drivers/hinge/hinge_driver.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// Writes the values of each driver of `drivers` to the scratch memory `rows` (kRowLanes floats per
// row), lane l for driver l of block b: row b.first_row is "flexed", the next is "extended" =
// 1 - flexed.
//
// flexed = Bend() of the lower bone away from the straight direction, times smoothstep(0, 0.5,
// cosine between the axis and the normal of their plane): it counts fully up to 60 degrees from the
// hinge's plane and fades to 0 at 90 degrees, so hyperextension gives 0. Without an axis, or for a
// straight limb, the factor is 1. The straight direction is the stated one, or that of the upper
// bone. A bone that counts and has no length gives flexed = 0.
template <bool kScaled>
void EvaluateDrivers(const HingeDriverSet& drivers, const PointPlan& plan, LanePose<kScaled> pose,
                     const DriverInput& input, float* rows) {
  const auto evaluate = [&](const HingeBlock& block, std::size_t lane, float* to) HWY_ATTR {
    const BoneLanes bones = EvaluateBones(plan, block, pose, lane);
    const Mask fixed = LoadMask(block.has_straight, lane);
    // Lanes with and without a stated bone share a block; each lane selects its own.
    const Float3 straight = IfThenElse(fixed, LoadRows(block.straight, lane), bones.upper.unit);
    const Float3& lower = bones.lower.unit;
    const Float bend = Bend(Dot(straight, lower), Splat(1.0f), LoadRow(block.bend_scale, lane));
    const Float3 normal = Cross(straight, lower);
    const Float sine = hn::Sqrt(Dot(normal, normal));
    // NaN or infinite for parallel bones, whose plane is undefined. `is_signed` excludes these
    // lanes.
    const Float along = hn::Div(Dot(normal, LoadRows(block.axis, lane)), sine);
    const Float share = Smoothstep(0.0f, kFullAlongAxis, along);
    const Mask is_signed = hn::And(LoadMask(block.has_axis, lane), hn::Gt(sine, Splat(kLeastSine)));
    const Float turned = hn::IfThenElse(is_signed, hn::Mul(bend, share), bend);
    const Mask counts = hn::And(bones.lower.has_length, hn::Or(fixed, bones.upper.has_length));
    const Float flexed = hn::IfThenElseZero(counts, turned);
    StoreLanes(flexed, to);
    StoreLanes(hn::Sub(Splat(1.0f), flexed), to + kRowLanes);
  };
  ForEachBlock(drivers.blocks(), input.num_values, rows, evaluate);
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
