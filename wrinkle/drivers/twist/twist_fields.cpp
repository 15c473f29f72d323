// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/twist/twist_fields.h"

#include "base/scalar.h"
#include "wrinkle/drivers/common/full_pose_builder.h"
#include "wrinkle/fields/field_check.h"
#include "wrinkle/fields/rig_field.h"

namespace furrow::wrinkle {

std::vector<std::string> DriverValueNames(const TwistDriver&) {
  return {"twist_left", "twist_right"};
}

float ValueAtAngle(const TwistDriver& driver, std::string_view, float degrees) {
  return Saturate(degrees / driver.full_degrees);
}

void CheckFields(const TwistDriver& driver, const std::string& at, FieldCheck* check) {
  check->Label(at, ".joint", driver.joint);
  check->Count(at, ".through", driver.through.size(), 64);
  for (std::size_t i = 0; i < driver.through.size(); ++i) {
    check->Label(FieldAt(at + ".through", i), "", driver.through[i]);
  }
  if (driver.axis) check->Direction(at, ".axis", *driver.axis);
  check->Range(at, ".full_degrees", driver.full_degrees, 1.0f, 180.0f);
}

std::vector<std::string> JointsRead(const TwistDriver& driver) {
  std::vector<std::string> joints = {driver.joint};
  joints.insert(joints.end(), driver.through.begin(), driver.through.end());
  return joints;
}

std::vector<std::string> JointsInfluenced(const TwistDriver& driver) { return JointsRead(driver); }

Result<ReferencePose> FullPose(const TwistDriver& driver, const FullPoseBuilder& builder) {
  const Skeleton& skeleton = builder.skeleton();
  const std::vector<std::string> names = JointsRead(driver);
  const float sign = builder.value() == "twist_left" ? 1.0f : -1.0f;
  // Every joint takes an equal part, because the driver reads the sum.
  const float angle = sign * builder.degrees().value_or(driver.full_degrees) * kDegrees /
                      static_cast<float>(names.size());
  ReferencePose pose = builder.Empty();
  for (const std::string& name : names) {
    const int joint = skeleton.Find(name);
    if (joint == kNoJoint) return builder.MissingJoint(name);
    const glm::vec3 own = skeleton.rest_model_rotations()[joint] * skeleton.tails()[joint];
    const glm::vec3 axis = Direction(driver.axis.value_or(own));
    if (axis == glm::vec3(0.0f)) return builder.CannotPose("joint '" + name + "' has no tail");
    pose.joints.push_back({.joint = name, .rotation = glm::angleAxis(angle, axis)});
  }
  return pose;
}

}  // namespace furrow::wrinkle
