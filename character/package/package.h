// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "character/character.h"
#include "character/gltf/gltf_writer.h"
#include "character/source_notes.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/pose_frame.h"

// Reading and writing character packages: a glTF file, its wrinkle rig and the rig's pictures.
namespace furrow::character {

// Reads a .glb or .gltf file and its rig. An empty `rig` means "<stem>.rig.json" beside the file,
// if it exists.
//
// - `poses` reads the reference poses that name a file (rig/rig_file.h).
// - The file is untrusted: sizes are checked before allocation, then indices, finite numbers, skin
//   weights (the strongest four, renormalised) and the skeleton's tree. Errors name the file and
//   the field ("face.glb: meshes[0].primitives[0].attributes.JOINTS_0").
// - Missing normals and tangents are computed.
// - The rig's pictures are loaded: embedded ones by name, files by FindAsset(). Missing ones are
//   listed in Character::missing_rig_pictures.
[[nodiscard]] Result<Character> LoadCharacter(const std::filesystem::path& glb,
                                              const std::filesystem::path& rig = {},
                                              const wrinkle::PoseSource& poses = {});

// As LoadCharacter() without a rig, from bytes in memory. `folder` holds the files of a .gltf. The
// `where` of errors is the field alone; the character's name may be empty.
[[nodiscard]] Result<Character> ParseCharacter(std::string_view bytes,
                                               const std::filesystem::path& folder,
                                               const ReadOptions& options = {});

// Replaces a character's rig and loads the rig's pictures, searching `folder` first.
[[nodiscard]] Status AttachRig(wrinkle::Rig rig, const std::filesystem::path& folder,
                               Character* character);

// The names of all pictures that a rig uses, masks first, without duplicates.
[[nodiscard]] std::vector<std::string> RigPictureNames(const wrinkle::Rig& rig);

// Writes the .glb with WriteFileAtomically().
[[nodiscard]] Status SaveCharacterGlb(const Character& character, const std::filesystem::path& glb);

}  // namespace furrow::character
