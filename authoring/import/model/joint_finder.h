// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "rig/skeleton_map.h"
#include "wrinkle/skeleton/joint_role.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// Which joint is what, and how that was found out.
struct FoundJoints {
  wrinkle::JointRoles roles;  // one a joint
  std::string map;            // the skeleton map that knew the names; empty: told by the hierarchy
  int num_roles = 0;          // different ones

  // The topmost joint of a role, or the lowest; kNoJoint when nobody holds it.
  [[nodiscard]] int First(wrinkle::JointRole role) const;
  [[nodiscard]] int Last(wrinkle::JointRole role) const;
};

// Roles by the names that `maps` know; where no map knows the skeleton, by its hierarchy: the
// branches of the body (two like legs and a spine, two like arms and a neck), and the sides by
// where the toes point. A guess for a person to check.
[[nodiscard]] FoundJoints FindJoints(const wrinkle::Skeleton& skeleton,
                                     const character::SkeletonMaps& maps);

}  // namespace furrow::authoring
