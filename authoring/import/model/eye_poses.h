// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "character/mesh/mesh.h"
#include "gltf/scene/vrm_look_at.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/joint_role.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// A model's eyes, besides their joints.
struct EyeSurface {
  std::span<const character::Mesh> meshes;  // upright (+Y), facing +Z
  std::optional<gltf::VrmLookAt> look_at;   // the avatar's own ranges
};

// Adds the eight reference poses eyeLookUpLeft to eyeLookOutRight, by which streams with ARKit's
// shapes turn the joints of the eyes. Poses that the rig has stay. A shape at 1 counts as a gaze of
// 30 degrees.
//
// Without ranges, eyeballs turn by 30 degrees to the sides and down and by 25 up. A flat iris, as
// of drawn characters, moves by a fifth of its width to the sides and by an eighth up and down:
// farther, it would sink into the eye.
//
// Returns false, and adds nothing, if the skeleton lacks the role of an eye.
bool AddEyePoses(const wrinkle::Skeleton& skeleton, const wrinkle::JointRoles& roles,
                 const EyeSurface& eyes, wrinkle::Rig* rig);

}  // namespace furrow::authoring
