// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/status.h"
#include "character/character.h"

namespace furrow::authoring {

// Adds ARKit's 52 blend shapes to a character with a jointed face, as morph targets of all its
// meshes. A shape is the difference that the rig's reference pose of the same name makes to the
// skinned surface; its normals follow the moved surface.
//
// - mouthClose is the difference on the open jaw, where trackers send it: jawOpen = mouthClose = 1
//   closes the lips.
// - tongueOut also moves the tongue out, which has no joint.
// Precondition: the character has no shapes yet. Errors: kNotFound (the rig has no reference pose
// for a shape, or the skeleton lacks a joint of the pose).
[[nodiscard]] Status AddFaceShapes(character::Character* character);

}  // namespace furrow::authoring
