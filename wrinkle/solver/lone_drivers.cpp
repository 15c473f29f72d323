// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/solver/lone_drivers.h"

#include <array>
#include <span>

#include "wrinkle/rig/rig_check.h"
#include "wrinkle/solver/binding_data.h"

namespace furrow::wrinkle {
namespace {

// Point `index` of those that a lane has left in rows.
glm::vec3 PointAt(std::span<const LonePoints> points, std::size_t lane, std::size_t index,
                  const float* scratch) {
  const std::size_t row = points[lane / kRowLanes].first_row + 3 * index;
  const float* const at = scratch + row * kRowLanes + lane % kRowLanes;
  return {at[0], at[kRowLanes], at[2 * kRowLanes]};
}

void EvaluateNnls(const BindingData& data, const LoneDriver& driver, float* scratch) {
  std::array<glm::vec3, kMaxControlPoints> moved;
  for (std::size_t i = 0; i < driver.num_lanes; ++i) {
    moved[i] = PointAt(data.lanes.nnls_points, driver.first_lane + i, 0, scratch);
  }
  data.pose_drivers.EvaluateMoved(driver.entry, std::span(moved).first(driver.num_lanes),
                                  {scratch + driver.first_number, driver.num_values});
}

void EvaluateStrain(const BindingData& data, const LoneDriver& driver, float* scratch) {
  std::array<StrainDriverSet::Frame, kMaxPatchJoints> frames;
  for (std::size_t i = 0; i < driver.num_lanes; ++i) {
    std::array<glm::vec3, StrainDriverSet::kFramePoints> points;
    for (std::size_t k = 0; k < points.size(); ++k) {
      points[k] = PointAt(data.lanes.strain_frames, driver.first_lane + i, k, scratch);
    }
    frames[i] = StrainDriverSet::MakeFrame(points);
  }
  data.strain_drivers.EvaluateFrames(driver.entry, std::span(frames).first(driver.num_lanes),
                                     {scratch + driver.first_number, driver.num_values});
}

}  // namespace

void EvaluateLoneDrivers(const BindingData& data, std::size_t num_values, float* scratch) {
  for (const LoneDriver& driver : data.lanes.nnls) {
    if (driver.first_value < num_values) EvaluateNnls(data, driver, scratch);
  }
  for (const LoneDriver& driver : data.lanes.strains) {
    if (driver.first_value < num_values) EvaluateStrain(data, driver, scratch);
  }
}

}  // namespace furrow::wrinkle
