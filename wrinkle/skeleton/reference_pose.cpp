// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/reference_pose.h"

#include <glm/geometric.hpp>

#include "base/ascii.h"

namespace furrow::wrinkle {
namespace {

constexpr float kLeastDelta = 1e-6f;  // radians, source units

// The formula of JointDelta, in the precision of the pose. `own` and `above`: the rest rotations of
// the joint and of its parent in model space.
template <class Quaternion, class Vector, class Joint>
void Apply(const Quaternion& turn, const Vector& moved, const Quaternion& own,
           const Quaternion& above, Joint* local) {
  // `turn` is about model axes at rest. Conjugation with the rest rotation expresses it in the
  // joint's own axes, where it is applied after the pose so far.
  local->rotation = glm::normalize(local->rotation * glm::conjugate(own) * turn * own);
  local->translation += glm::conjugate(above) * moved;
}

}  // namespace

float ShapeValueOf(const ReferencePose& pose, std::string_view blend_shape) {
  for (const ShapeValue& shape : pose.shapes) {
    if (EqualsIgnoreCase(shape.blend_shape, blend_shape)) return shape.value;
  }
  return 0.0f;
}

bool IsRest(const JointDelta& delta) {
  const float turn = glm::length(glm::vec3(delta.rotation.x, delta.rotation.y, delta.rotation.z));
  return turn < kLeastDelta && glm::length(delta.translation) < kLeastDelta &&
         glm::length(delta.unscaled_translation) < kLeastDelta;
}

void ApplyJointDelta(const JointDelta& delta, const Skeleton& skeleton, int joint, float scale,
                     Transform* local) {
  Apply(delta.rotation, delta.translation * scale + delta.unscaled_translation,
        RestRotation(skeleton, joint), RestRotation(skeleton, skeleton.joint_parents()[joint]),
        local);
}

void ApplyJointDelta(const JointDelta& delta, const Skeleton& skeleton, int joint, float scale,
                     PreciseTransform* local) {
  const auto precise = [](const glm::quat& q) { return glm::normalize(glm::dquat(q)); };
  Apply(precise(delta.rotation),
        glm::dvec3(delta.translation) * double{scale} + glm::dvec3(delta.unscaled_translation),
        precise(RestRotation(skeleton, joint)),
        precise(RestRotation(skeleton, skeleton.joint_parents()[joint])), local);
}

float ReferencePoseScale(const ReferencePose& pose, const Skeleton& skeleton) {
  if (!(pose.source_size > 0.0f)) return 1.0f;
  return SkeletonSizeBy(pose.size_reference.get(), skeleton) / pose.source_size;
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
