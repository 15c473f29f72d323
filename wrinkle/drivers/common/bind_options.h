// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>

namespace furrow::wrinkle {

// The joints of a skeleton that together do what one joint of a rig does, parents first: three
// joints of a neck for one. Several joints of a rig may share joints of the skeleton.
struct RoleChain {
  std::string joint;  // in the rig
  std::vector<std::string> skeleton_joints;
};

// How RigBinding::Create() treats names that the skeleton lacks.
struct BindOptions {
  // false: a joint or blend shape that the skeleton lacks is an error. true (live streams): its
  // driver rests at 0 and RigBinding lists it as missing.
  bool allow_missing = false;
  // Pairs (joint name in the rig, joint name in the skeleton), tried if the skeleton has no joint
  // with the rig's name.
  std::span<const std::pair<std::string, std::string>> aliases;
  // For twist drivers, which add the joints of a chain. A chain wins over a joint with the rig's
  // name.
  std::span<const RoleChain> role_chains;
  // From the skeleton's model space to Furrow's (+Y up, facing +Z), in which rigs state axes, sides
  // and reference poses; see FindRestStance(). Poses keep the skeleton's own model space.
  glm::quat turn{1.0f, 0.0f, 0.0f, 0.0f};
};

}  // namespace furrow::wrinkle
