// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "authoring/generator/body/body_shape.h"
#include "authoring/generator/head/face_parameters.h"
#include "authoring/generator/head/head_grid.h"
#include "base/status.h"
#include "character/character.h"

namespace furrow::authoring {

// How the face of a generated character moves.
enum class FaceKind {
  kJoints,       // joints that follow the muscles
  kBlendShapes,  // ARKit's 52 blend shapes (MakeBlendShapeFace())
};

// The options of MakeDefaultCharacter() and WriteCharacter().
struct CharacterOptions {
  FaceParameters face;
  BodyParameters body;
  int level = kDefaultLevel;  // level of detail of the head's mesh, 0 coarsest to 2 finest
  // Width and height of the pictures of skin, cloth and wrinkles, texels. Those of masks,
  // eyes and hair are half as wide and high.
  int texture_size = 1024;
  FaceKind face_kind = FaceKind::kJoints;  // of WriteCharacter(); MakeDefaultCharacter() has joints
};

// Makes the default character (CC0), without wrinkle maps: a clothed body with a face whose joints
// follow the muscles. Its textures and masks are embedded pictures with the names that the rig
// default.json uses. The character holds a copy of `rig`. The same rig and options always
// give the same bytes.
[[nodiscard]] character::Character MakeDefaultCharacter(const wrinkle::Rig& rig,
                                                        const CharacterOptions& options = {});

// Makes a character, bakes its wrinkle maps, and writes the file `glb`, then its rig beside it
// (NAME.rig.json). `rigs`: the folder of default.json and default.strokes.json, which are read.
// Errors: those of LoadRig(), LoadStrokes(), AddWrinkleMaps(), MakeBlendShapeFace(),
// SaveCharacterGlb() and of writing the rig; `glb` may exist then.
[[nodiscard]] Status WriteCharacter(const std::filesystem::path& rigs,
                                    const CharacterOptions& options,
                                    const std::filesystem::path& glb);

// Writes the contents of share/furrow except the elder: default.glb with its rig, a copy of the
// folder `rigs` in rigs/, and recordings/*.bvh. Creates missing folders. Errors: kIo, and those of
// WriteCharacter(); files that were already written remain.
[[nodiscard]] Status WriteShare(const std::filesystem::path& rigs,
                                const std::filesystem::path& share);

// Writes the second shipped character, a woman of 65. Errors: those of WriteCharacter().
[[nodiscard]] Status WriteElder(const std::filesystem::path& rigs,
                                const std::filesystem::path& glb);

}  // namespace furrow::authoring
