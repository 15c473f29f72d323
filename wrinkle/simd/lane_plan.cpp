// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/simd/lane_plan.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "wrinkle/simd/lane_planner.h"

namespace furrow::wrinkle {
namespace {

constexpr std::int32_t kLaneYes = -1;  // of a mask
constexpr std::int32_t kLaneNo = 0;
constexpr auto OfOneKind = [](int) { return 0; };

// kNoJoint: the lane's chain has ended. It reads the first joint, for nothing.
void SetJoint(int joint, std::size_t lane, JointStep* step) {
  const bool active = joint != kNoJoint;
  constexpr auto kNumbers = static_cast<std::int32_t>(sizeof(Transform) / sizeof(float));
  step->joints.at[lane] = active ? joint * kNumbers : 0;
  step->active.at[lane] = active ? kLaneYes : kLaneNo;
  step->all_active = step->all_active && active;
}

}  // namespace

void LanePlanner::Place(int first_value, std::size_t num_values, std::size_t lane, Block* block) {
  const auto first = static_cast<std::uint32_t>(first_value);
  block->num_lanes = static_cast<std::uint32_t>(lane + 1);
  block->first_value = lane == 0 ? first : std::min(block->first_value, first);
  for (std::size_t i = 0; i < num_values; ++i) {
    places_[first + i] = static_cast<std::uint32_t>((block->first_row + i) * kRowLanes + lane);
  }
}

void LanePlanner::PlaceAlone(LoneDriver* driver) {
  driver->first_number = AddRows(NumRows(driver->num_values)) * kRowLanes;
  for (std::uint32_t i = 0; i < driver->num_values; ++i) {
    places_[driver->first_value + i] = driver->first_number + i;
  }
}

std::uint32_t LanePlanner::AddPoints(const Lanes& points) {
  PointRow row;
  row.first_step = static_cast<std::uint32_t>(plan_.steps.size());
  row.is_origin = true;
  std::size_t num_up = 0;
  std::size_t num_down = 0;
  for (std::size_t lane = 0; lane < kRowLanes; ++lane) {
    const JointChains::Chain chain = data_.chains.chain(points[lane]);
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
    const JointChains::Chain chain = data_.chains.chain(points[lane]);
    const std::span<const std::int16_t> joints = up ? chain.up : chain.down;
    SetJoint(index < joints.size() ? joints[index] : kNoJoint, lane, &step);
  }
}

template <class Entry>
auto LanePlanner::LengthOfBones(std::span<const Entry> entries) const {
  return [this, entries](int i) {
    const JointChains::Chain chain =
        data_.chains.chain(entries[static_cast<std::size_t>(i)].bones.end_point);
    return std::pair(chain.down.size(), chain.up.size());
  };
}

template <class Entry>
void LanePlanner::BindBones(std::span<const Entry> entries, const Lanes& lanes,
                            std::size_t num_values, BoneBlock* block) {
  Lanes joints;
  Lanes ends;
  block->first_row = AddRows(num_values);
  for (std::size_t lane = 0; lane < lanes.count; ++lane) {
    const Entry& entry = entries[static_cast<std::size_t>(lanes[lane])];
    Place(entry.first_value, num_values, lane, block);
    joints.Add(entry.bones.joint_point);
    ends.Add(entry.bones.end_point);
    block->bend_scale.at[lane] = entry.bend_scale;
  }
  block->joint_point = AddPoints(joints);
  block->end_point = AddPoints(ends);
}

void LanePlanner::AddHinges() {
  const std::span entries = data_.hinge_drivers.entries();
  for (const Lanes& lanes : InBlocks(entries.size(), OfOneKind, LengthOfBones(entries))) {
    HingeBlock& block = plan_.hinges.emplace_back();
    BindBones(entries, lanes, 2, &block);
    for (std::size_t lane = 0; lane < lanes.count; ++lane) {
      const HingeDriverSet::Entry& entry = entries[static_cast<std::size_t>(lanes[lane])];
      SetLane(entry.axis, lane, block.axis);
      block.has_axis.at[lane] = entry.axis != glm::vec3(0.0f) ? kLaneYes : kLaneNo;
    }
  }
}

void LanePlanner::AddBalls() {
  const std::span entries = data_.ball_drivers.entries();
  const auto mode = [&](int i) { return entries[static_cast<std::size_t>(i)].mode; };
  for (const Lanes& lanes : InBlocks(entries.size(), mode, LengthOfBones(entries))) {
    BallBlock& block = plan_.balls.emplace_back();
    block.mode = mode(lanes[0]);
    BindBones(entries, lanes, 4, &block);
    for (std::size_t lane = 0; lane < lanes.count; ++lane) {
      const BallDriverSet::Entry& entry = entries[static_cast<std::size_t>(lanes[lane])];
      SetLane(entry.straight, lane, block.straight);
      block.has_straight.at[lane] = entry.straight != glm::vec3(0.0f) ? kLaneYes : kLaneNo;
      SetLane(entry.forward, lane, block.forward);
      SetLane(entry.right, lane, block.right);
    }
  }
}

void LanePlanner::AddTwists() {
  const std::span entries = data_.twist_drivers.entries();
  const auto num_joints = [&](int i) { return entries[static_cast<std::size_t>(i)].num_joints; };
  for (const Lanes& lanes : InBlocks(entries.size(), OfOneKind, num_joints)) {
    TwistBlock& block = plan_.twists.emplace_back();
    block.first_row = AddRows(2);
    block.first_step = static_cast<std::uint32_t>(plan_.twist_steps.size());
    for (std::size_t lane = 0; lane < lanes.count; ++lane) {
      const TwistDriverSet::Entry& entry = entries[static_cast<std::size_t>(lanes[lane])];
      Place(entry.first_value, 2, lane, &block);
      block.inverse_full.at[lane] = entry.inverse_full;
      block.num_steps = std::max(block.num_steps, static_cast<std::uint32_t>(entry.num_joints));
    }
    for (std::uint32_t i = 0; i < block.num_steps; ++i) AddTwistStep(lanes, i);
  }
}

void LanePlanner::AddTwistStep(const Lanes& lanes, std::size_t index) {
  TwistStep& step = plan_.twist_steps.emplace_back();
  for (std::size_t lane = 0; lane < kRowLanes; ++lane) {
    const auto& entry = data_.twist_drivers.entries()[static_cast<std::size_t>(lanes[lane])];
    const auto joints = data_.twist_drivers.joints(entry);
    const bool active = lane < lanes.count && index < joints.size();
    SetJoint(active ? joints[index].joint : kNoJoint, lane, &step.joint);
    if (!active) continue;
    const glm::quat& r = joints[index].rest_inverse;
    SetLane(glm::vec4(r.x, r.y, r.z, r.w), lane, step.rest_inverse);
    SetLane(joints[index].axis, lane, step.axis);
  }
}

void LanePlanner::AddBlendShapes() {
  const std::span entries = data_.blend_shape_drivers.entries();
  for (const Lanes& lanes : InBlocks(entries.size(), OfOneKind, OfOneKind)) {
    BlendShapeBlock& block = plan_.blend_shapes.emplace_back();
    block.first_row = AddRows(1);
    for (std::size_t lane = 0; lane < kRowLanes; ++lane) {
      const auto& entry = entries[static_cast<std::size_t>(lanes[lane])];
      if (lane < lanes.count) Place(entry.first_value, 1, lane, &block);
      block.blend_shape.at[lane] = entry.blend_shape;
      block.neutral.at[lane] = entry.neutral;
      block.range.at[lane] = entry.full - entry.neutral;
    }
  }
}

LanePlan MakeLanePlan(const BindingData& data) { return LanePlanner(data).Plan(); }

}  // namespace furrow::wrinkle
