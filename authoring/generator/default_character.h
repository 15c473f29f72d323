// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "authoring/generator/body/body_shape.h"
#include "authoring/generator/head/face_parameters.h"
#include "authoring/generator/head/head_grid.h"
#include "base/status.h"
#include "character/character.h"

namespace furrow::authoring {

struct CharacterOptions {
  FaceParameters face;
  BodyParameters body;
  int level = kDefaultLevel;  // of detail of the head's mesh, 0 to 2
  int texture_size = 1024;    // of skin, cloth and wrinkle maps; masks, eyes and hair take half
};

// The default character (CC0): a clothed body with a face on muscle joints, textures and masks as
// embedded pictures under the names that rig/rigs/default.json uses; AddWrinkleMaps() bakes
// his wrinkle maps. `rig` is stored in him. The same options give the same bytes on every run.
[[nodiscard]] character::Character MakeDefaultCharacter(const wrinkle::Rig& rig,
                                                        const CharacterOptions& options = {});

// Makes a character and bakes its wrinkle maps: `glb`, and its rig beside it (NAME.rig.json, a copy
// of default.json in `rigs`). Errors: those of reading, baking and writing.
[[nodiscard]] Status WriteCharacter(const std::filesystem::path& rigs,
                                    const CharacterOptions& options,
                                    const std::filesystem::path& glb);

// Writes the data that programs find in share/furrow: default.glb, elder.glb (a woman of 65) and
// their rigs, the rigs of
// `rigs` under rigs/, and recordings/*.bvh. Folders are made. Errors: those of reading and writing.
[[nodiscard]] Status WriteShare(const std::filesystem::path& rigs,
                                const std::filesystem::path& share);

}  // namespace furrow::authoring
