// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/hinge/hinge_driver.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "base/scalar.h"
#include "wrinkle/drivers/hinge/hinge.h"
#include "wrinkle/rig/driver_values.h"

namespace furrow::wrinkle {

Status HingeDriverSet::Bind(const Driver& driver, int first_value, BindContext* context) {
  const HingeDriver& hinge = driver.hinge;
  const std::string whose = "driver '" + driver.name + "'";
  Entry entry;
  entry.first_value = first_value;
  entry.bend_scale = BendScale(hinge.beta_degrees);
  bool usable = false;
  if (Status status = BindBonePair(whose, hinge.parent, hinge.joint, hinge.end, true, context,
                                   &entry.bones, &usable);
      !status.ok() || !usable) {
    return status;
  }
  if (hinge.axis) {
    const Skeleton& skeleton = context->skeleton();
    const glm::vec3 axis = Direction(ToJointAxes(skeleton, entry.bones.parent, *hinge.axis));
    const glm::vec3 upper = entry.bones.Upper(skeleton.rest_pose(), context->chains());
    const glm::vec3 across = axis - glm::dot(axis, upper) * upper;
    if (glm::length(across) < kLeastAcross) {
      return context->Unusable(whose, "axis lies along the upper bone");
    }
    entry.axis = Direction(across);
  }
  entries_.push_back(entry);
  return {};
}

void HingeDriverSet::Evaluate(std::span<const Transform> local, const JointChains& chains,
                              std::span<float> driver_values) const {
  for (const Entry& entry : entries_) {
    if (!Reaches(driver_values, entry.first_value)) break;
    const glm::vec3 upper = entry.bones.Upper(local, chains);
    const glm::vec3 lower = entry.bones.Lower(local, chains);
    float flexed = 0.0f;
    if (upper != glm::vec3(0.0f) && lower != glm::vec3(0.0f)) {
      flexed = entry.axis == glm::vec3(0.0f)
                   ? Bend(glm::dot(upper, lower), entry.bend_scale)
                   : SignedBend(upper, lower, entry.axis, entry.bend_scale);
    }
    driver_values[entry.first_value] = flexed;
    driver_values[entry.first_value + 1] = 1.0f - flexed;
  }
}

float HingeDriverSet::AngleDegrees(int entry, std::span<const Transform> local,
                                   const JointChains& chains) const {
  const Entry& e = entries_[entry];
  const glm::vec3 upper = e.bones.Upper(local, chains);
  const glm::vec3 lower = e.bones.Lower(local, chains);
  const glm::vec3 normal = glm::cross(upper, lower);
  const float angle = std::atan2(glm::length(normal), glm::dot(upper, lower)) / kDegrees;
  return glm::dot(normal, e.axis) < 0.0f ? -angle : angle;
}

}  // namespace furrow::wrinkle
