// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "character/character.h"
#include "character/gltf/gltf_skeleton.h"
#include "character/gltf/gltf_writer.h"
#include "character/source_notes.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/pose_frame.h"

// Reading and writing character packages: a glTF file, its wrinkle rig and the rig's pictures.
namespace furrow::character {

// Where the rig of a character lies: "<stem>.rig.json" in the folder of its .glb or .gltf file.
[[nodiscard]] std::filesystem::path RigBeside(const std::filesystem::path& glb);

// The package that a user names: a file, or a shipped character ("elder" or "elder.glb"). See
// FileOrShipped().
[[nodiscard]] std::filesystem::path FindCharacterFile(const std::string& name_or_file);

// Reads a .glb or .gltf file and its rig. An empty `rig` means RigBeside(glb); if that does not
// exist, the character has no rig.
//
// - `poses` loads the reference poses that the rig takes from a file. If it is empty, a rig with
//   such poses is kUnsupported.
// - The package may state the roles of its joints (Character::roles); an unknown role is kSchema.
// - The file is untrusted: sizes are checked before allocation, then indices, finite numbers, skin
//   weights (the strongest four, renormalised) and the skeleton's tree. Errors name the file and
//   the field ("face.glb: meshes[0].primitives[0].attributes.JOINTS_0").
// - Missing normals and tangents are computed.
// - The rig's pictures are loaded: embedded ones by name, files by FindAsset(). Missing ones are
//   listed in Character::missing_rig_pictures.
//   With kColours and kStandIns, the rig's pictures are stand-ins. With kLeaveOut, the character
//   has no pictures, and damaged pictures are accepted.
[[nodiscard]] Result<Character> LoadCharacter(const std::filesystem::path& glb,
                                              const std::filesystem::path& rig = {},
                                              const wrinkle::PoseSource& poses = {},
                                              Pictures pictures = Pictures::kLoad);

// Reads a character without a rig from `bytes`, a whole .glb or .gltf file, with the checks of
// LoadCharacter(). `folder`: holds the files that a .gltf names. `where` of errors is the field
// without a file name. The character's name is empty if the file does not state one.
[[nodiscard]] Result<Character> ParseCharacter(std::string_view bytes,
                                               const std::filesystem::path& folder,
                                               const ReadOptions& options = {});

// The names of a package's joints and the roles that it states for them, as in Character::roles.
// Reads neither meshes nor pictures. Errors: those of LoadCharacter() for nodes and skins.
[[nodiscard]] Result<NamedRoles> LoadCharacterRoles(const std::filesystem::path& glb);

// Replaces a character's rig and loads the rig's pictures, searching `folder` first. A picture that
// does not exist is listed in Character::missing_rig_pictures. Errors: those of CheckAssetName()
// and LoadPicture() (a damaged picture). After an error, the character has the new rig with only
// some of its pictures. Unless `pictures` is kLoad, no file is read, and its picture has no pixels.
[[nodiscard]] Status AttachRig(wrinkle::Rig rig, const std::filesystem::path& folder,
                               Character* character, Pictures pictures = Pictures::kLoad);

// The names of all pictures that a rig uses, masks first, without duplicates.
[[nodiscard]] std::vector<std::string> RigPictureNames(const wrinkle::Rig& rig);

// Writes the character without its rig as a .glb file. Replaces the file only on success. Errors:
// those of CharacterGlb(), and kIo.
[[nodiscard]] Status SaveCharacterGlb(const Character& character, const std::filesystem::path& glb);

}  // namespace furrow::character
