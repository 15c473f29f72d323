// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "rig/skeleton_map.h"
#include "wrinkle/skeleton/joint_role.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// The roles of a skeleton's joints, and how they were determined.
struct FoundJoints {
  wrinkle::JointRoles roles;  // one per joint
  // The skeleton map that matched the names; empty: from the hierarchy; rig::kFromPackage.
  std::string map;
  int num_roles = 0;  // number of different roles

  // The index of the first or the last joint of a role, in the skeleton's order (parents first);
  // kNoJoint if no joint has the role.
  [[nodiscard]] int First(wrinkle::JointRole role) const;
  [[nodiscard]] int Last(wrinkle::JointRole role) const;
};

// `stated`: the roles that the model's own package states (Character::roles). They hold unless the
// user chose a map. Otherwise: determines roles from names that `maps` contain. If the hierarchy
// tells more (SkeletonMaps::RolesOrGuess()), roles follow from it: one fork with two legs and a
// spine, another with two arms and a neck, and the direction of the toes for the sides. The result
// from the hierarchy is a guess that a person should check.
[[nodiscard]] FoundJoints FindJoints(const wrinkle::Skeleton& skeleton,
                                     const rig::SkeletonMaps& maps,
                                     const wrinkle::JointRoles& stated = {});

// "22 roles by names of 'mixamo'", "19 roles guessed from the hierarchy", "22 roles stated by the
// file" or "no known roles".
[[nodiscard]] std::string Describe(const FoundJoints& joints);

}  // namespace furrow::authoring
