// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gltf/scene/vrm_look_at.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/joint_role.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// Adds the eight reference poses eyeLookUpLeft to eyeLookOutRight, by which streams with ARKit's
// shapes turn the joints of the eyes. Poses that the rig has stay. `look_at`: the avatar's own
// ranges; without them, 30 degrees to the sides and down and 25 up. A shape at 1 counts as a gaze
// of 30 degrees.
//
// `skeleton` is upright (+Y) and faces +Z. Returns false, and adds nothing, if the skeleton lacks
// the role of an eye.
bool AddEyePoses(const wrinkle::Skeleton& skeleton, const wrinkle::JointRoles& roles,
                 const std::optional<gltf::VrmLookAt>& look_at, wrinkle::Rig* rig);

}  // namespace furrow::authoring
