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
  int level = kDefaultLevel;  // level of detail of the head's mesh, 0 to 2
  int texture_size =
      1024;  // of skin, cloth and wrinkle maps, texels; masks, eyes and hair have half
};

// Makes the default character (CC0): a clothed body with a face on muscle joints. Textures and
// masks are embedded pictures with the names that rig/rigs/default.json uses. The character holds
// `rig`. AddWrinkleMaps() bakes its wrinkle maps. The same options always give the same bytes.
[[nodiscard]] character::Character MakeDefaultCharacter(const wrinkle::Rig& rig,
                                                        const CharacterOptions& options = {});

// Makes a character, bakes its wrinkle maps, and writes it to `glb` with its rig beside it
// (NAME.rig.json, a copy of default.json in `rigs`). Errors: those of reading, baking and writing.
[[nodiscard]] Status WriteCharacter(const std::filesystem::path& rigs,
                                    const CharacterOptions& options,
                                    const std::filesystem::path& glb);

// Writes the contents of share/furrow: default.glb and elder.glb (a woman of 65) with their rigs, a
// copy of `rigs` in rigs/, and recordings/*.bvh. Creates missing folders. Errors: those of reading,
// baking and writing.
[[nodiscard]] Status WriteShare(const std::filesystem::path& rigs,
                                const std::filesystem::path& share);

}  // namespace furrow::authoring
