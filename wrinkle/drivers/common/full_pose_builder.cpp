// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/common/full_pose_builder.h"

#include <cmath>

#include <glm/gtx/quaternion.hpp>

#include "base/scalar.h"
#include "wrinkle/drivers/common/bone_pair.h"

namespace furrow::wrinkle {

Result<ReferencePose> FullPoseBuilder::FromRig(const std::string& name) const {
  for (const ReferencePose& pose : reference_poses_) {
    if (pose.name == name) return pose;
  }
  return Status(StatusCode::kNotFound, "driver '" + std::string(driver_) +
                                           "' names reference pose '" + name +
                                           "', which the rig does not have");
}

ReferencePose FullPoseBuilder::Empty() const {
  return {.name = std::string(driver_) + "." + std::string(value_)};
}

Result<Limb> FullPoseBuilder::FindLimb(const std::string& parent, const std::string& joint,
                                       const std::string& end) const {
  const int parent_index = skeleton_.Find(parent);
  if (parent_index == kNoJoint) return MissingJoint(parent);
  Limb limb;
  limb.joint = skeleton_.Find(joint);
  if (limb.joint == kNoJoint) return MissingJoint(joint);
  const int end_index = end.empty() ? limb.joint : skeleton_.Find(end);
  if (end_index == kNoJoint) return MissingJoint(end);
  const auto origin = [&](int index) { return glm::vec3(skeleton_.rest_model()[index][3]); };
  const glm::vec3 tip = end.empty() ? glm::vec3(skeleton_.rest_model()[limb.joint] *
                                                glm::vec4(skeleton_.tails()[limb.joint], 1.0f))
                                    : origin(end_index);
  limb.upper = Direction(origin(limb.joint) - origin(parent_index));
  limb.lower = Direction(tip - origin(limb.joint));
  if (limb.lower == glm::vec3(0.0f)) return CannotPose("its lower bone has no length");
  return limb;
}

ReferencePose FullPoseBuilder::Bent(const Limb& limb, const glm::vec3& straight,
                                    const glm::vec3& side, float beta_degrees) const {
  // Both directions point away from the trunk: with beta between the bones, they differ by pi -
  // beta.
  const float angle = kPi - beta_degrees * kDegrees;
  return Turned(limb, std::cos(angle) * straight + std::sin(angle) * side, side);
}

ReferencePose FullPoseBuilder::Turned(const Limb& limb, const glm::vec3& target,
                                      const glm::vec3& side) const {
  ReferencePose pose = Empty();
  // glm::rotation() picks an arbitrary axis for opposite directions, which could bend an elbow
  // backwards. The half turn by way of `side` is the meant one.
  glm::quat turn = glm::rotation(limb.lower, target);
  if (glm::dot(limb.lower, target) < -kAlmostStraight) {
    const glm::vec3 axis = Direction(glm::cross(limb.lower, side));
    if (axis != glm::vec3(0.0f)) turn = glm::angleAxis(kPi, axis);
  }
  pose.joints.push_back({.joint = skeleton_.joint_names()[limb.joint], .rotation = turn});
  return pose;
}

Status FullPoseBuilder::CannotPose(const std::string& why) const {
  return {StatusCode::kInvalidArgument,
          "driver '" + std::string(driver_) + "' cannot be posed: " + why};
}

Status FullPoseBuilder::MissingJoint(const std::string& joint) const {
  return {StatusCode::kNotFound, "driver '" + std::string(driver_) + "' names joint '" + joint +
                                     "', which the skeleton does not have"};
}

Status FullPoseBuilder::Unsupported() const {
  return {StatusCode::kUnsupported,
          "no pose of the joints raises driver '" + std::string(driver_) + "'"};
}

glm::vec3 AcrossBone(const glm::vec3& direction, const glm::vec3& bone) {
  const glm::vec3 unit = Direction(direction);
  const glm::vec3 across = unit - glm::dot(unit, bone) * bone;
  return glm::length(across) < kLeastAcross ? glm::vec3(0.0f) : Direction(across);
}

}  // namespace furrow::wrinkle
