// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/hinge/hinge_driver.h"

#include <cmath>

#include "base/scalar.h"

namespace furrow::wrinkle {

Status HingeDriverSet::Bind(const std::string& name, const HingeDriver& driver, int first_value,
                            BindContext* context) {
  const std::string owner = "driver '" + name + "'";
  Entry entry;
  entry.first_value = first_value;
  entry.bend_scale = BendScale(driver.beta_degrees);
  bool usable = false;
  const bool needs_upper = !driver.bone;
  FURROW_RETURN_IF_ERROR(BindBonePair(owner, driver.parent, driver.joint, driver.end, needs_upper,
                                      context, &entry.bones, &usable));
  if (!usable) return {};
  // Directions are stated in model axes at rest and kept in the parent's axes, as the points are.
  const Skeleton& skeleton = context->skeleton();
  const int parent = entry.bones.parent;
  if (driver.bone) entry.straight = Direction(ToJointAxes(skeleton, parent, *driver.bone));
  // Only the part of the axis across the straight bone tells flexion from hyperextension.
  if (driver.axis) {
    const glm::vec3 axis = Direction(ToJointAxes(skeleton, parent, *driver.axis));
    const glm::vec3 straight = entry.Straight(skeleton.rest_pose(), context->chains());
    const glm::vec3 across = axis - glm::dot(axis, straight) * straight;
    if (glm::length(across) < kLeastAcross) {
      return context->Unusable(owner, "axis lies along the straight bone");
    }
    entry.axis = Direction(across);
  }
  entries_.push_back(entry);
  return {};
}

void HingeDriverSet::Plan(LanePlanner* planner) {
  const auto length = LengthOfBones(entries(), planner->chains());
  for (const Lanes& lanes : InBlocks(entries_.size(), kOneKind, length)) {
    HingeBlock& block = blocks_.emplace_back();
    std::vector<BoneEntry> bones;
    for (std::size_t lane = 0; lane < lanes.count; ++lane) {
      const Entry& entry = entries_[static_cast<std::size_t>(lanes[lane])];
      bones.push_back(entry);
      SetLane(entry.straight, lane, block.straight);
      block.has_straight.at[lane] = entry.straight != glm::vec3(0.0f) ? kLaneYes : kLaneNo;
      SetLane(entry.axis, lane, block.axis);
      block.has_axis.at[lane] = entry.axis != glm::vec3(0.0f) ? kLaneYes : kLaneNo;
      block.bend_scale.at[lane] = entry.bend_scale;
    }
    PlanBones(bones, 2, planner, &block);
  }
}

void HingeDriverSet::Explain(const SolvedPose& pose, DriverExplanation* explanation) const {
  for (const Entry& entry : entries_) {
    const glm::vec3 straight = entry.Straight(pose.local, pose.chains);
    const glm::vec3 lower = entry.bones.Lower(pose.local, pose.chains);
    // atan2 of sine and cosine stays accurate near 0 and 180 degrees, where acos loses half its
    // digits.
    const glm::vec3 normal = glm::cross(straight, lower);
    const float angle = std::atan2(glm::length(normal), glm::dot(straight, lower)) / kDegrees;
    explanation->angles.push_back(
        {.driver = pose.DriverName(entry.first_value),
         .what = "flexion",
         .degrees = glm::dot(normal, entry.axis) < 0.0f ? -angle : angle});
  }
}

}  // namespace furrow::wrinkle
