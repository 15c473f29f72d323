// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/eye_poses.h"

#include <algorithm>
#include <string>

#include <glm/trigonometric.hpp>

namespace furrow::authoring {
namespace {

using wrinkle::JointRole;

constexpr float kFullGaze = 30.0f;  // degrees; our judgement, as ARKit states none

const std::string* JointOf(const wrinkle::Skeleton& skeleton, const wrinkle::JointRoles& roles,
                           JointRole role) {
  const auto found = std::ranges::find(roles, role);
  if (found == roles.end()) return nullptr;
  return &skeleton.joint_names()[static_cast<std::size_t>(found - roles.begin())];
}

float Degrees(const gltf::VrmLookAt::Range& range) {
  return range.output * (range.input > kFullGaze ? kFullGaze / range.input : 1.0f);
}

void AddPose(const std::string& name, const std::string& joint, const glm::vec3& axis,
             float degrees, wrinkle::Rig* rig) {
  const auto is_same = [&](const wrinkle::ReferencePose& pose) { return pose.name == name; };
  if (std::ranges::any_of(rig->reference_poses, is_same)) return;
  wrinkle::ReferencePose& pose = rig->reference_poses.emplace_back();
  pose.name = name;
  pose.joints.push_back({.joint = joint, .rotation = glm::angleAxis(glm::radians(degrees), axis)});
}

}  // namespace

bool AddEyePoses(const wrinkle::Skeleton& skeleton, const wrinkle::JointRoles& roles,
                 const std::optional<gltf::VrmLookAt>& look_at, wrinkle::Rig* rig) {
  const std::string* left = JointOf(skeleton, roles, JointRole::kLeftEye);
  const std::string* right = JointOf(skeleton, roles, JointRole::kRightEye);
  if (left == nullptr || right == nullptr) return false;
  const gltf::VrmLookAt::Range side{kFullGaze, 30.0f}, up{kFullGaze, 25.0f};
  const gltf::VrmLookAt ranges = look_at.value_or(gltf::VrmLookAt{side, side, side, up});
  // Model axes: X to the subject's left, Y up, Z to the front.
  const glm::vec3 x(1.0f, 0.0f, 0.0f), y(0.0f, 1.0f, 0.0f);
  for (const bool is_left : {true, false}) {
    const std::string& joint = is_left ? *left : *right;
    const std::string suffix = is_left ? "Left" : "Right";
    const float outwards = is_left ? 1.0f : -1.0f;
    AddPose("eyeLookUp" + suffix, joint, x, -Degrees(ranges.up), rig);
    AddPose("eyeLookDown" + suffix, joint, x, Degrees(ranges.down), rig);
    AddPose("eyeLookOut" + suffix, joint, y, outwards * Degrees(ranges.outer), rig);
    AddPose("eyeLookIn" + suffix, joint, y, -outwards * Degrees(ranges.inner), rig);
  }
  return true;
}

}  // namespace furrow::authoring
