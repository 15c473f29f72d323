// SPDX-License-Identifier: Apache-2.0
// Evaluates strain drivers. The frames of the joints (four points each) are computed one joint per
// SIMD lane, then each driver by itself, because patches differ too much in size to share lanes.
#if defined(FURROW_WRINKLE_STRAIN_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_STRAIN_LANES_INL_H_
#undef FURROW_WRINKLE_STRAIN_LANES_INL_H_
#else
#define FURROW_WRINKLE_STRAIN_LANES_INL_H_
#endif

#include <array>

#include "wrinkle/drivers/strain/strain_driver.h"
#include "wrinkle/simd/lane_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// Writes the values of one driver to `rows` from driver.first_number on, one after another. The
// points of its frames are in `rows` already.
inline void EvaluateStrain(const StrainDriverSet& drivers, const SingleDriver& driver,
                           std::span<const float> blend_shapes, float* rows) {
  std::array<StrainDriverSet::Frame, kMaxPatchJoints> frames;
  for (std::size_t i = 0; i < driver.num_lanes; ++i) {
    const std::size_t lane = driver.first_lane + i;
    const StrainFrameBlock& block = drivers.frame_blocks()[lane / kRowLanes];
    std::array<glm::vec3, StrainDriverSet::kFramePoints> points;
    for (std::size_t k = 0; k < points.size(); ++k) {
      points[k] = StoredPoint(block, lane % kRowLanes, k, rows);
    }
    frames[i] = StrainDriverSet::MakeFrame(points);
  }
  drivers.EvaluateFrames(driver.entry, std::span(frames).first(driver.num_lanes), blend_shapes,
                         {rows + driver.first_number, driver.num_values});
}

// Writes the values of each driver of `drivers` to the scratch memory `rows` (kRowLanes floats per
// row), four consecutive floats per driver: along, across, diagonal_left and diagonal_right.
template <bool kScaled>
void EvaluateDrivers(const StrainDriverSet& drivers, const PointPlan& plan, LanePose<kScaled> pose,
                     const DriverInput& input, float* rows) {
  // Twelve rows per block: x, y and z of each of the four points.
  const auto evaluate = [&](const StrainFrameBlock& block, std::size_t lane, float* to) HWY_ATTR {
    const FourPoints four = EvaluateFour(plan, &plan.points[block.first_point], pose, lane);
    for (const Float3& point : four.at) {
      StoreRows(point, to);
      to += 3 * kRowLanes;
    }
  };
  ForEachBlock(drivers.frame_blocks(), input.num_values, rows, evaluate);
  for (const SingleDriver& driver : drivers.drivers()) {
    if (driver.first_value < input.num_values)
      EvaluateStrain(drivers, driver, input.blend_shapes, rows);
  }
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
