// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/reference_pose.h"

#include <glm/geometric.hpp>

#include "wrinkle/skeleton/direction.h"
#include "wrinkle/skeleton/retarget.h"

namespace furrow::wrinkle {
namespace {

constexpr float kLeastDelta = 1e-6f;  // radians, source units

}  // namespace

bool IsRest(const JointDelta& delta) {
  const float turn = glm::length(glm::vec3(delta.rotation.x, delta.rotation.y, delta.rotation.z));
  return turn < kLeastDelta && glm::length(delta.translation) < kLeastDelta &&
         glm::length(delta.unscaled_translation) < kLeastDelta;
}

void ApplyJointDelta(const JointDelta& delta, const Skeleton& skeleton, int joint, float scale,
                     Transform* local) {
  const glm::quat& rest_model = skeleton.rest_model_rotations()[joint];
  // `delta` turns about model axes at rest. Conjugation with the rest rotation expresses it in the
  // joint's own axes, where it is applied after the pose so far.
  local->rotation =
      glm::normalize(local->rotation * glm::conjugate(rest_model) * delta.rotation * rest_model);
  const glm::vec3 moved = delta.translation * scale + delta.unscaled_translation;
  local->translation += ToJointAxes(skeleton, skeleton.joint_parents()[joint], moved);
}

void ApplyJointDelta(const JointDelta& delta, const Skeleton& skeleton, int joint, float scale,
                     PreciseTransform* local) {
  const auto rest_model = [&](int index) {
    if (index == kNoJoint) return glm::dquat(1.0, 0.0, 0.0, 0.0);
    return glm::normalize(glm::dquat(skeleton.rest_model_rotations()[index]));
  };
  const glm::dquat own = rest_model(joint);
  const glm::dquat turn = glm::normalize(glm::dquat(delta.rotation));
  local->rotation = glm::normalize(local->rotation * glm::conjugate(own) * turn * own);
  const glm::dvec3 moved =
      glm::dvec3(delta.translation) * double{scale} + glm::dvec3(delta.unscaled_translation);
  local->translation += glm::conjugate(rest_model(skeleton.joint_parents()[joint])) * moved;
}

float ReferencePoseScale(const ReferencePose& pose, const Skeleton& skeleton) {
  return pose.source_size > 0.0f ? SkeletonSize(skeleton) / pose.source_size : 1.0f;
}

Status ApplyReferencePose(const ReferencePose& pose, const Skeleton& skeleton,
                          std::span<Transform> locals) {
  for (const JointDelta& delta : pose.joints) {
    if (IsRest(delta) || skeleton.Find(delta.joint) != kNoJoint) continue;
    return {StatusCode::kNotFound, "reference pose '" + pose.name + "': joint names joint '" +
                                       delta.joint + "', which the skeleton does not have"};
  }
  const float scale = ReferencePoseScale(pose, skeleton);
  for (const JointDelta& delta : pose.joints) {
    if (IsRest(delta)) continue;
    const int joint = skeleton.Find(delta.joint);
    ApplyJointDelta(delta, skeleton, joint, scale, &locals[static_cast<std::size_t>(joint)]);
  }
  return {};
}

}  // namespace furrow::wrinkle
