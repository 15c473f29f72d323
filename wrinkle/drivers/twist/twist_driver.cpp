// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/twist/twist_driver.h"

#include "base/scalar.h"
#include "base/status.h"
#include "wrinkle/rig/driver_values.h"
#include "wrinkle/skeleton/twist.h"

namespace furrow::wrinkle {

Status TwistDriverSet::Bind(const Driver& driver, int first_value, BindContext* context) {
  const TwistDriver& twist = driver.twist;
  const std::string whose = "driver '" + driver.name + "'";
  const Skeleton& skeleton = context->skeleton();
  std::vector<std::string> names = {twist.joint};
  names.insert(names.end(), twist.through.begin(), twist.through.end());
  std::vector<TwistJoint> joints;
  bool usable = true;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Result<int> found = context->Joint(whose, i == 0 ? "joint" : "through", names[i]);
    FURROW_RETURN_IF_ERROR(found);
    if (*found == kNoJoint) {
      usable = false;
      continue;
    }
    TwistJoint joint;
    joint.joint = *found;
    joint.rest_inverse = glm::conjugate(glm::normalize(skeleton.rest_pose()[*found].rotation));
    joint.axis = Direction(twist.axis ? ToJointAxes(skeleton, *found, *twist.axis)
                                      : skeleton.tails()[*found]);
    if (joint.axis == glm::vec3(0.0f)) {
      return context->Unusable(whose, "joint '" + names[i] + "' has no tail to twist about");
    }
    joints.push_back(joint);
  }
  if (!usable) return {};
  entries_.push_back({.first_value = first_value,
                      .first_joint = static_cast<int>(joints_.size()),
                      .num_joints = static_cast<int>(joints.size()),
                      .inverse_full = 1.0f / (twist.full_degrees * kDegrees)});
  joints_.insert(joints_.end(), joints.begin(), joints.end());
  return {};
}

float TwistDriverSet::Angle(int entry, std::span<const Transform> local) const {
  const Entry& e = entries_[entry];
  float sum = 0.0f;
  for (int i = e.first_joint; i < e.first_joint + e.num_joints; ++i) {
    const TwistJoint& joint = joints_[i];
    sum += TwistAngle(joint.rest_inverse * local[joint.joint].rotation, joint.axis);
  }
  return sum;
}

void TwistDriverSet::Evaluate(std::span<const Transform> local,
                              std::span<float> driver_values) const {
  for (int i = 0; i < num_entries() && Reaches(driver_values, first_value(i)); ++i) {
    const float share = Angle(i, local) * entries_[i].inverse_full;
    driver_values[first_value(i)] = Saturate(share);
    driver_values[first_value(i) + 1] = Saturate(-share);
  }
}

}  // namespace furrow::wrinkle
