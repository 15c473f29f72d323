// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/twist/twist_driver.h"

#include <algorithm>

#include "base/scalar.h"
#include "wrinkle/skeleton/twist.h"

namespace furrow::wrinkle {

Status TwistDriverSet::Bind(const std::string& name, const TwistDriver& driver, int first_value,
                            BindContext* context) {
  const std::string owner = "driver '" + name + "'";
  const Skeleton& skeleton = context->skeleton();
  // The twist of a forearm or neck is often spread over several joints, so the driver sums all of
  // them. The driver rests if one is missing: a part of the sum would look like a smaller twist.
  const std::vector<std::string> names = JointsRead(driver);
  std::vector<TwistJoint> joints;
  bool usable = true;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Result<std::vector<int>> chain =
        context->JointChain(owner, i == 0 ? "joint" : "through", names[i]);
    FURROW_RETURN_IF_ERROR(chain);
    usable = usable && !chain->empty();
    for (const int index : *chain) {
      // Another skeleton may have one joint for several of the rig's. Its twist counts once.
      if (std::ranges::count(joints, index, &TwistJoint::joint) > 0) continue;
      TwistJoint joint;
      joint.joint = index;
      joint.rest_inverse = glm::conjugate(context->RestRotationInPose(index));
      joint.axis = Direction(driver.axis ? ToJointAxes(skeleton, index, *driver.axis)
                                         : skeleton.tails()[index]);
      if (joint.axis == glm::vec3(0.0f)) {
        return context->Unusable(
            owner, "joint '" + skeleton.joint_names()[index] + "' has no tail to twist about");
      }
      joints.push_back(joint);
    }
  }
  if (!usable) return {};
  entries_.push_back({.first_value = first_value,
                      .first_joint = static_cast<int>(joints_.size()),
                      .num_joints = static_cast<int>(joints.size()),
                      .inverse_full = 1.0f / (driver.full_degrees * kDegrees)});
  joints_.insert(joints_.end(), joints.begin(), joints.end());
  return {};
}

void TwistDriverSet::Plan(LanePlanner* planner) {
  const auto num_joints = [&](int i) { return entries_[static_cast<std::size_t>(i)].num_joints; };
  for (const Lanes& lanes : InBlocks(entries_.size(), kOneKind, num_joints)) {
    TwistBlock& block = blocks_.emplace_back();
    block.first_row = planner->AddRows(2);
    block.first_step = static_cast<std::uint32_t>(steps_.size());
    for (std::size_t lane = 0; lane < lanes.count; ++lane) {
      const Entry& entry = entries_[static_cast<std::size_t>(lanes[lane])];
      planner->Place(entry.first_value, 2, lane, &block);
      block.inverse_full.at[lane] = entry.inverse_full;
      block.num_steps = std::max(block.num_steps, static_cast<std::uint32_t>(entry.num_joints));
    }
    for (std::uint32_t i = 0; i < block.num_steps; ++i) PlanStep(lanes, i);
  }
}

// Lanes with fewer joints than the block are inactive in its last steps. Their angle does not
// count.
void TwistDriverSet::PlanStep(const Lanes& lanes, std::size_t index) {
  TwistStep& step = steps_.emplace_back();
  for (std::size_t lane = 0; lane < kRowLanes; ++lane) {
    const auto own = joints(entries_[static_cast<std::size_t>(lanes[lane])]);
    const bool active = lane < lanes.count && index < own.size();
    SetJoint(active ? own[index].joint : kNoJoint, lane, &step.joint);
    if (!active) continue;
    const glm::quat& r = own[index].rest_inverse;
    SetLane(glm::vec4(r.x, r.y, r.z, r.w), lane, step.rest_inverse);
    SetLane(own[index].axis, lane, step.axis);
  }
}

void TwistDriverSet::Explain(const SolvedPose& pose, DriverExplanation* explanation) const {
  for (const Entry& entry : entries_) {
    float radians = 0.0f;
    for (const TwistJoint& joint : joints(entry)) {
      radians += TwistAngle(joint.rest_inverse * pose.local[joint.joint].rotation, joint.axis);
    }
    explanation->angles.push_back({.driver = pose.DriverName(entry.first_value),
                                   .what = "twist",
                                   .degrees = radians / kDegrees});
  }
}

}  // namespace furrow::wrinkle
