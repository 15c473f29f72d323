// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "rig/skeleton_map.h"

namespace furrow::rig {

// The roles of the map that the joint names nearly match: a name counts for a joint that contains
// it, whatever the case and the characters between its letters and digits. "ctl_Left_Up_Leg_jnt"
// nearly matches "LeftUpLeg". The longest name counts, and of several joints the first one.
//
// This is a guess that a person must check, so nothing uses it but proposals. The result's `map` is
// empty if no map has kMinRoles such roles.
[[nodiscard]] SkeletonRoles RolesOfNearNames(std::span<const SkeletonMap> maps,
                                             std::span<const std::string> joint_names);

}  // namespace furrow::rig
