// SPDX-License-Identifier: Apache-2.0
// Evaluates blend-shape drivers, one driver per SIMD lane.
#if defined(FURROW_WRINKLE_BLEND_SHAPE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_BLEND_SHAPE_LANES_INL_H_
#undef FURROW_WRINKLE_BLEND_SHAPE_LANES_INL_H_
#else
#define FURROW_WRINKLE_BLEND_SHAPE_LANES_INL_H_
#endif

#include "wrinkle/drivers/blend_shape/blend_shape_driver.h"
#include "wrinkle/simd/lane_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// Writes the value of each driver of `drivers` to the scratch memory `rows`:
//   value = clamp((coefficient - neutral) / (full - neutral), 0, 1)
//
// `rows`: kRowLanes floats per row. Block b writes row b.first_row; lane l holds its driver l.
// Coefficients past the end of input.blend_shapes count as 0. The kernel calls EvaluateDrivers() of
// every kind alike; points and pose are unused because blend shapes read no joints.
template <bool kScaled>
void EvaluateDrivers(const BlendShapeDriverSet& drivers, const PointPlan&, LanePose<kScaled>,
                     const DriverInput& input, float* rows) {
  const auto evaluate = [&](const BlendShapeBlock& block, std::size_t lane, float* to) HWY_ATTR {
    const Float coefficients = LoadCoefficients(input.blend_shapes, block.blend_shape, lane);
    const Float above = hn::Sub(coefficients, LoadRow(block.neutral, lane));
    StoreLanes(Saturate(hn::Div(above, LoadRow(block.range, lane))), to);
  };
  ForEachBlock(drivers.blocks(), input.num_values, rows, evaluate);
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
