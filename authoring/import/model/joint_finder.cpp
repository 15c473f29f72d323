// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/joint_finder.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "wrinkle/hierarchy/hierarchy_roles.h"

namespace furrow::authoring {

using wrinkle::JointRole;
using wrinkle::kNoJoint;
using wrinkle::Skeleton;

int FoundJoints::First(JointRole role) const {
  const auto found = std::find(roles.begin(), roles.end(), role);
  return found == roles.end() ? kNoJoint : static_cast<int>(found - roles.begin());
}

int FoundJoints::Last(JointRole role) const {
  const auto found = std::find(roles.rbegin(), roles.rend(), role);
  return found == roles.rend() ? kNoJoint : static_cast<int>(roles.rend() - found) - 1;
}

FoundJoints FindJoints(const Skeleton& skeleton, const rig::SkeletonMaps& maps,
                       const wrinkle::JointRoles& stated) {
  const bool holds = !stated.empty() && !maps.is_chosen();
  rig::SkeletonRoles known = holds ? rig::RolesOfPackage(stated) : maps.RolesOrGuess(skeleton);
  FoundJoints found;
  if (known.map != rig::kFromHierarchy) found.map = std::move(known.map);
  // Without any maps, nothing has been guessed yet.
  found.roles =
      known.roles.empty() ? wrinkle::RolesFromHierarchy(skeleton) : std::move(known.roles);
  found.roles.resize(static_cast<std::size_t>(skeleton.num_joints()), JointRole::kNone);
  std::vector<bool> seen(wrinkle::kNumJointRoles, false);
  for (const JointRole role : found.roles) {
    if (role == JointRole::kNone || seen[static_cast<std::size_t>(role)]) continue;
    seen[static_cast<std::size_t>(role)] = true;
    ++found.num_roles;
  }
  return found;
}

std::string Describe(const FoundJoints& joints) {
  if (joints.num_roles == 0) return "no known roles";
  std::string from = "by names of '" + joints.map + "'";
  if (joints.map.empty()) from = "guessed from the hierarchy";
  if (joints.map == rig::kFromPackage) from = "stated by the file";
  return std::to_string(joints.num_roles) + " roles " + from;
}

}  // namespace furrow::authoring
