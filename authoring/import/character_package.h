// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/status.h"
#include "character/character.h"

namespace furrow::authoring {

// Writes a character as two files that together are the whole package: `glb`, with all pictures
// embedded, and "<stem>.rig.json" beside it, with all reference poses inline.
//
// On an error neither file is written. Errors: those of CheckRig(), errors of encoding the glTF,
// kIo.
[[nodiscard]] Status WriteCharacterPackage(const character::Character& character,
                                           const std::filesystem::path& glb);

}  // namespace furrow::authoring
