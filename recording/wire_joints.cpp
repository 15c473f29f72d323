// SPDX-License-Identifier: Apache-2.0
#include "recording/wire_joints.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

namespace furrow::recording {
namespace {

glm::vec3 ToVec(const protocol::Vec3& v) { return {v.x, v.y, v.z}; }

// A rotation of the wire as a unit quaternion. The wire allows lengths within 1e-3 of 1; the solver
// needs unit quaternions. One that is of unit length to float precision passes unchanged, since
// normalizing it again would change its last bits, and with them the weights.
glm::quat ToUnitQuat(const protocol::Quat& q) {
  constexpr float kUnit = 1e-6f;
  const glm::quat rotation(q.w, q.x, q.y, q.z);
  return std::abs(glm::dot(rotation, rotation) - 1.0f) <= kUnit ? rotation
                                                                : glm::normalize(rotation);
}

// An empty list of indices means that the values cover all elements in order.
std::size_t IndexAt(std::span<const std::uint16_t> indices, std::size_t i) {
  return indices.empty() ? i : indices[i];
}

}  // namespace

std::vector<wrinkle::JointDesc> JointsOf(const protocol::SkeletonOffer& offer, float scale) {
  std::vector<wrinkle::JointDesc> joints;
  joints.reserve(offer.joints.size());
  for (const protocol::OfferedJoint& joint : offer.joints) {
    wrinkle::JointDesc& desc = joints.emplace_back();
    desc.name = joint.name;
    // The codec has checked that each parent comes before its children.
    desc.parent = joint.parent < 0 ? wrinkle::kNoJoint : joint.parent;
    desc.rest.translation = scale * ToVec(joint.rest_translation);
    desc.rest.rotation = ToUnitQuat(joint.rest_rotation);
    desc.rest.scale = ToVec(joint.rest_scale);
    if (joint.has_tail) desc.tail = scale * ToVec(joint.tail);
  }
  return joints;
}

void ApplyWirePose(const protocol::PoseFrame& frame, const WireTarget& target,
                   std::span<wrinkle::Transform> joints, std::span<float> blend_shapes) {
  // A whole pose lists only what differs from rest, so everything else must return to rest.
  if (!frame.partial) {
    std::ranges::copy(target.rest, joints.begin());
    std::ranges::fill(blend_shapes, 0.0f);
  }
  const auto joint_at = [&target](std::span<const std::uint16_t> indices, std::size_t i) {
    return static_cast<std::size_t>(target.joint_of_wire[IndexAt(indices, i)]);
  };
  for (std::size_t i = 0; i < frame.rotations.size(); ++i) {
    joints[joint_at(frame.rotation_joints, i)].rotation = ToUnitQuat(frame.rotations[i]);
  }
  for (std::size_t i = 0; i < frame.translations.size(); ++i) {
    const std::size_t joint = joint_at(frame.translation_joints, i);
    // The wire carries translations as offsets from rest, which are 0 for most joints.
    joints[joint].translation =
        target.rest[joint].translation + target.scale * ToVec(frame.translations[i]);
  }
  for (std::size_t i = 0; i < frame.scales.size(); ++i) {
    joints[joint_at(frame.scale_joints, i)].scale = ToVec(frame.scales[i]);
  }
  for (std::size_t i = 0; i < frame.blend_shapes.size(); ++i) {
    blend_shapes[IndexAt(frame.blend_shape_indices, i)] = frame.blend_shapes[i];
  }
}

}  // namespace furrow::recording
