// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/hinge/hinge_fields.h"

#include <cmath>

#include "base/scalar.h"
#include "wrinkle/drivers/common/bone_pair.h"
#include "wrinkle/drivers/common/full_pose_builder.h"
#include "wrinkle/fields/field_check.h"

namespace furrow::wrinkle {

std::vector<std::string> DriverValueNames(const HingeDriver&) { return {"flexed", "extended"}; }

float ValueAtAngle(const HingeDriver& driver, std::string_view value, float degrees) {
  const float bend =
      Saturate((1.0f - std::cos(degrees * kDegrees)) * BendScale(driver.beta_degrees));
  return value == "extended" ? 1.0f - bend : bend;
}

void CheckFields(const HingeDriver& driver, const std::string& at, FieldCheck* check) {
  check->Label(at, ".parent", driver.parent);
  check->Label(at, ".joint", driver.joint);
  if (!driver.end.empty()) check->Label(at, ".end", driver.end);
  if (driver.bone) check->Direction(at, ".bone", *driver.bone);
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
  const glm::vec3 straight = driver.bone ? Direction(*driver.bone) : limb->upper;
  if (straight == glm::vec3(0.0f)) return builder.CannotPose("its upper bone has no length");
  if (builder.value() == "extended" && !builder.degrees()) {
    return builder.Turned(*limb, straight, straight);
  }
  // Without an axis, the bend at rest shows in which direction the limb bends.
  const glm::vec3 given = driver.axis.value_or(glm::cross(straight, limb->lower));
  const bool rests_straight = glm::dot(straight, limb->lower) > kAlmostStraight;
  if (!driver.axis && rests_straight) {
    return builder.CannotPose("it states no axis, and the limb is straight at rest");
  }
  const glm::vec3 axis = AcrossBone(given, straight);
  if (axis == glm::vec3(0.0f)) return builder.CannotPose("its axis lies along the straight bone");
  const float bend = builder.degrees().value_or(180.0f - driver.beta_degrees);
  return builder.Bent(*limb, straight, glm::cross(axis, straight), 180.0f - bend);
}

}  // namespace furrow::wrinkle
