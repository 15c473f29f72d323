// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/eye_poses.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "rig/shapes/arkit_shapes.h"

namespace furrow::authoring {
namespace {

using rig::kFullGaze;
using wrinkle::JointRole;

// The joint of an eyeball is in its middle. A flat iris, as of drawn characters, turns about a
// joint far behind it.
constexpr float kFarBehind = 0.75f;  // in widths of what follows the joint
constexpr float kIrisSide = 0.2f;    // how far a flat iris moves, in its widths
constexpr float kIrisUp = 0.12f;

int JointOf(const wrinkle::JointRoles& roles, JointRole role) {
  const auto found = std::ranges::find(roles, role);
  return found == roles.end() ? wrinkle::kNoJoint : static_cast<int>(found - roles.begin());
}

// The width of a flat iris over the distance of its joint; nullopt for an eyeball, and if nothing
// follows the joint.
std::optional<float> FlatIris(std::span<const character::Mesh> meshes, int joint,
                              const glm::vec3& origin) {
  glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (const character::Mesh& mesh : meshes) {
    for (const character::Vertex& vertex : mesh.vertices) {
      float weight = 0.0f;
      for (int k = 0; k < 4; ++k) {
        if (vertex.joints[k] == joint) weight += vertex.skin_weights[k];
      }
      if (weight <= 0.5f) continue;
      low = glm::min(low, vertex.position);
      high = glm::max(high, vertex.position);
    }
  }
  const float width = high.x - low.x;
  const float distance = glm::distance(0.5f * (low + high), origin);
  if (!(width > 0.0f) || distance < kFarBehind * width) return std::nullopt;
  return width / distance;
}

gltf::VrmLookAt RangesOf(const wrinkle::Skeleton& skeleton, const EyeSurface& eyes, int eye) {
  if (eyes.look_at) return *eyes.look_at;
  const auto range = [](float degrees) { return gltf::VrmLookAt::Range{kFullGaze, degrees}; };
  const auto iris = FlatIris(eyes.meshes, eye, wrinkle::RestOrigin(skeleton, eye));
  if (!iris) return {range(30.0f), range(30.0f), range(30.0f), range(25.0f)};
  const auto side = range(glm::degrees(kIrisSide * *iris));
  const auto up = range(glm::degrees(kIrisUp * *iris));
  return {side, side, up, up};
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
                 const EyeSurface& eyes, wrinkle::Rig* rig) {
  const int left = JointOf(roles, JointRole::kLeftEye);
  const int right = JointOf(roles, JointRole::kRightEye);
  if (left == wrinkle::kNoJoint || right == wrinkle::kNoJoint) return false;
  // Model axes: X to the subject's left, Y up, Z to the front.
  const glm::vec3 x(1.0f, 0.0f, 0.0f), y(0.0f, 1.0f, 0.0f);
  for (const bool is_left : {true, false}) {
    const int eye = is_left ? left : right;
    const gltf::VrmLookAt ranges = RangesOf(skeleton, eyes, eye);
    const std::string& joint = skeleton.joint_names()[static_cast<std::size_t>(eye)];
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
