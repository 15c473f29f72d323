// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/ball/ball_driver.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "base/scalar.h"

namespace furrow::wrinkle {
namespace {

// The projection of a direction across the straight direction: towards forward, towards right.
glm::vec2 Projected(const glm::vec3& direction, const BallDriverSet::Entry& entry) {
  return {glm::dot(direction, entry.forward), glm::dot(direction, entry.right)};
}

// The direction of the bend, not normalised; `cosine` is that of the bend. The kernel has the same
// formula.
glm::vec2 BendSide(const BallDriverSet::Entry& entry, float cosine, const glm::vec3& across) {
  const glm::vec2 side = Projected(across, entry);
  if (entry.mode == BallMode::kThesis) return side;
  const float beyond = std::max(kTurnCosine - cosine, 0.0f);
  return side + kTurnGain * beyond * beyond * entry.rest_side;
}

}  // namespace

Status BallDriverSet::Bind(const std::string& name, const BallDriver& driver, int first_value,
                           BindContext* context) {
  const std::string owner = "driver '" + name + "'";
  const Skeleton& skeleton = context->skeleton();
  // Without a stated bone, the posed upper bone counts as straight. The rest pose then serves only
  // to find `forward` and `right` across it.
  const bool own_direction = driver.bone == glm::vec3(0.0f);
  Entry entry;
  entry.first_value = first_value;
  entry.ranges = {RangeOf(driver, driver.front), RangeOf(driver, driver.back),
                  RangeOf(driver, driver.left), RangeOf(driver, driver.right)};
  entry.mode = driver.mode;
  bool usable = false;
  FURROW_RETURN_IF_ERROR(BindBonePair(owner, driver.parent, driver.joint, driver.end, own_direction,
                                      context, &entry.bones, &usable));
  if (!usable) return {};
  const int parent = entry.bones.parent;
  glm::vec3 bone = Direction(driver.bone);  // model axes
  if (own_direction) {
    bone = skeleton.rest_model_rotations()[parent] *
           entry.bones.Upper(skeleton.rest_pose(), context->chains());
  } else {
    entry.straight = ToJointAxes(skeleton, parent, bone);
  }
  // The evaluator projects the lower bone onto `forward` and `right`, so both must lie across the
  // straight direction. All three are kept in the parent's axes, as the points are.
  const glm::vec3 forward = Direction(driver.forward);
  const glm::vec3 across = forward - glm::dot(forward, bone) * bone;
  if (glm::length(across) < kLeastAcross) {
    return context->Unusable(owner, "forward lies along the straight direction");
  }
  entry.forward = ToJointAxes(skeleton, parent, Direction(across));
  entry.right = ToJointAxes(skeleton, parent, SubjectsRight(bone, Direction(across)));
  const glm::vec2 rest =
      Projected(entry.bones.Lower(skeleton.rest_pose(), context->chains()), entry);
  entry.rest_side = rest / std::max(glm::length(rest), kLeastSide);
  entries_.push_back(entry);
  return {};
}

void BallDriverSet::Plan(LanePlanner* planner) {
  const auto mode = [&](int i) { return entries_[static_cast<std::size_t>(i)].mode; };
  // All lanes of a block share one mode, because the mode is a branch in the kernel.
  const auto length = LengthOfBones(entries(), planner->chains());
  for (const Lanes& lanes : InBlocks(entries_.size(), mode, length)) {
    BallBlock& block = blocks_.emplace_back();
    block.mode = mode(lanes[0]);
    std::vector<BoneEntry> bones;
    for (std::size_t lane = 0; lane < lanes.count; ++lane) {
      const Entry& entry = entries_[static_cast<std::size_t>(lanes[lane])];
      bones.push_back(entry);
      SetLane(entry.straight, lane, block.straight);
      block.has_straight.at[lane] = entry.straight != glm::vec3(0.0f) ? kLaneYes : kLaneNo;
      SetLane(entry.forward, lane, block.forward);
      SetLane(entry.right, lane, block.right);
      block.rest_side[0].at[lane] = entry.rest_side.x;
      block.rest_side[1].at[lane] = entry.rest_side.y;
      for (std::size_t side = 0; side < entry.ranges.size(); ++side) {
        block.start[side].at[lane] = entry.ranges[side].start;
        block.scale[side].at[lane] = entry.ranges[side].scale;
      }
    }
    PlanBones(bones, 4, planner, &block);
  }
}

void BallDriverSet::Explain(const SolvedPose& pose, DriverExplanation* explanation) const {
  const glm::vec3 none(0.0f);
  for (const Entry& entry : entries_) {
    // The same geometry as the kernel's, measured again in scalars: the kernel stores no angles.
    const glm::vec3 straight =
        entry.straight == none ? entry.bones.Upper(pose.local, pose.chains) : entry.straight;
    const glm::vec3 lower = entry.bones.Lower(pose.local, pose.chains);
    const bool has_bones = straight != none && lower != none;
    const float cosine = has_bones ? glm::dot(straight, lower) : 1.0f;
    const glm::vec3 across = has_bones ? lower - cosine * straight : none;
    const glm::vec2 bent = Projected(across, entry);
    const glm::vec2 side = BendSide(entry, cosine, across);
    const std::string driver = pose.DriverName(entry.first_value);
    explanation->angles.push_back({.driver = driver,
                                   .what = "bend",
                                   .degrees = std::atan2(glm::length(bent), cosine) / kDegrees});
    explanation->angles.push_back(
        {.driver = driver, .what = "direction", .degrees = std::atan2(side.y, side.x) / kDegrees});
  }
}

}  // namespace furrow::wrinkle
