// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/joint_finder.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "rig/hierarchy_roles.h"

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

FoundJoints FindJoints(const Skeleton& skeleton, const rig::SkeletonMaps& maps) {
  rig::SkeletonRoles known = maps.RolesOf(skeleton);
  FoundJoints found;
  found.map = std::move(known.map);
  found.roles = found.map.empty() ? rig::RolesFromHierarchy(skeleton) : std::move(known.roles);
  found.roles.resize(static_cast<std::size_t>(skeleton.num_joints()), JointRole::kNone);
  std::vector<bool> seen(wrinkle::kNumJointRoles, false);
  for (const JointRole role : found.roles) {
    if (role == JointRole::kNone || seen[static_cast<std::size_t>(role)]) continue;
    seen[static_cast<std::size_t>(role)] = true;
    ++found.num_roles;
  }
  return found;
}

}  // namespace furrow::authoring
