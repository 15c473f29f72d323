// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "wrinkle/skeleton/joint_role.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::rig {

// Determines the roles of joints from the hierarchy and the rest pose, whatever the names: one fork
// with two legs and a spine, another with two arms and a neck, and the direction of the toes for
// the sides. The result is a guess that a person should check.
//
// One role per joint; empty if the hierarchy is not that of an upright body, such as a fox's.
[[nodiscard]] wrinkle::JointRoles RolesFromHierarchy(const wrinkle::Skeleton& skeleton);

}  // namespace furrow::rig
