// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/status.h"
#include "character/character.h"

namespace furrow::character {

// Encodes skeleton, roles, skin, meshes with their morph targets, materials and pictures as the
// bytes of a .glb file. Morph targets are sparse accessors, and shapes that move nothing are lost.
// The rig is not written. Equal characters give equal bytes: fields have a fixed order, and neither
// times nor paths are written. Errors: those of EncodePicture().
[[nodiscard]] Result<std::string> CharacterGlb(const Character& character);

}  // namespace furrow::character
