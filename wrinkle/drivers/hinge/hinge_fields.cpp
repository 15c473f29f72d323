// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/hinge/hinge_fields.h"

#include "wrinkle/drivers/common/bone_pair.h"
#include "wrinkle/drivers/common/full_pose_builder.h"
#include "wrinkle/fields/field_check.h"

namespace furrow::wrinkle {

std::vector<std::string> DriverValueNames(const HingeDriver&) { return {"flexed", "extended"}; }

void CheckFields(const HingeDriver& driver, const std::string& at, FieldCheck* check) {
  check->Label(at, ".parent", driver.parent);
  check->Label(at, ".joint", driver.joint);
  if (!driver.end.empty()) check->Label(at, ".end", driver.end);
  if (driver.axis) check->Direction(at, ".axis", *driver.axis);
  check->Range(at, ".beta_degrees", driver.beta_degrees, 0.0f, kMaxBetaDegrees);
}

std::vector<std::string> JointsRead(const HingeDriver& driver) {
  return {driver.parent, driver.joint, driver.end};
}

std::vector<std::string> JointsInfluenced(const HingeDriver& driver) { return {driver.joint}; }

Result<ReferencePose> FullPose(const HingeDriver& driver, const FullPoseBuilder& builder) {
  const Result<Limb> limb = builder.FindLimb(driver.parent, driver.joint, driver.end);
  FURROW_RETURN_IF_ERROR(limb);
  if (limb->upper == glm::vec3(0.0f)) return builder.CannotPose("its upper bone has no length");
  if (builder.value() == "extended") return builder.Turned(*limb, limb->upper, limb->upper);
  // Without an axis, the bend at rest shows in which direction the limb bends.
  const glm::vec3 given = driver.axis.value_or(glm::cross(limb->upper, limb->lower));
  const bool straight = glm::dot(limb->upper, limb->lower) > kAlmostStraight;
  if (!driver.axis && straight) {
    return builder.CannotPose("it states no axis, and the limb is straight at rest");
  }
  const glm::vec3 axis = AcrossBone(given, limb->upper);
  if (axis == glm::vec3(0.0f)) return builder.CannotPose("its axis lies along the upper bone");
  return builder.Bent(*limb, limb->upper, glm::cross(axis, limb->upper), driver.beta_degrees);
}

}  // namespace furrow::wrinkle
