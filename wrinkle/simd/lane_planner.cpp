// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/simd/lane_planner.h"

#include <algorithm>

namespace furrow::wrinkle {

void SetJoint(int joint, std::size_t lane, JointStep* step) {
  const bool active = joint != kNoJoint;
  // The kernel reads a pose as one list of floats, so joints are stored as indices into that list.
  constexpr auto kNumbers = static_cast<std::int32_t>(sizeof(Transform) / sizeof(float));
  step->joints.at[lane] = active ? joint * kNumbers : 0;
  step->active.at[lane] = active ? kLaneYes : kLaneNo;
  step->all_active = step->all_active && active;
}

void LanePlanner::Place(int first_value, std::size_t num_values, std::size_t lane, Block* block) {
  const auto first = static_cast<std::uint32_t>(first_value);
  block->num_lanes = static_cast<std::uint32_t>(lane + 1);
  block->first_value = lane == 0 ? first : std::min(block->first_value, first);
  // Value i of a driver is in row first_row + i. RowGather later brings the values into the order
  // of the rig.
  for (std::size_t i = 0; i < num_values; ++i) {
    places_[first + i] = static_cast<std::uint32_t>((block->first_row + i) * kRowLanes + lane);
  }
}

void LanePlanner::PlaceSingle(SingleDriver* driver) {
  driver->first_number = AddRows(NumRows(driver->num_values)) * kRowLanes;
  for (std::uint32_t i = 0; i < driver->num_values; ++i) {
    places_[driver->first_value + i] = driver->first_number + i;
  }
}

std::uint32_t LanePlanner::AddPoints(const Lanes& points) {
  PointRow row;
  row.first_step = static_cast<std::uint32_t>(plan_.steps.size());
  // A point at its joint's origin ignores the joint's rotation and scale, so the kernel starts with
  // the joint's translation. Every lane must have such a joint, because that first step has no
  // mask.
  row.is_origin = true;
  std::size_t num_up = 0;
  std::size_t num_down = 0;
  for (std::size_t lane = 0; lane < kRowLanes; ++lane) {
    const JointChains::Chain chain = chains_.chain(points[lane]);
    SetLane(chain.offset, lane, row.offset);
    row.is_origin = row.is_origin && !chain.up.empty() && chain.offset == glm::vec3(0.0f);
    num_up = std::max(num_up, chain.up.size());
    num_down = std::max(num_down, chain.down.size());
  }
  for (std::size_t i = 0; i < num_up; ++i) AddStep(points, i, true);
  for (std::size_t i = 0; i < num_down; ++i) AddStep(points, i, false);
  row.num_up = static_cast<std::uint16_t>(num_up);
  row.num_down = static_cast<std::uint16_t>(num_down);
  plan_.points.push_back(row);
  return static_cast<std::uint32_t>(plan_.points.size() - 1);
}

void LanePlanner::AddStep(const Lanes& points, std::size_t index, bool up) {
  JointStep& step = plan_.steps.emplace_back();
  for (std::size_t lane = 0; lane < kRowLanes; ++lane) {
    const JointChains::Chain chain = chains_.chain(points[lane]);
    const std::span<const std::int16_t> joints = up ? chain.up : chain.down;
    SetJoint(index < joints.size() ? joints[index] : kNoJoint, lane, &step);
  }
}

}  // namespace furrow::wrinkle
