// SPDX-License-Identifier: Apache-2.0
#include "character/package/package.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "base/asset_path.h"
#include "base/data_dir.h"
#include "base/files.h"
#include "base/status.h"
#include "character/gltf/gltf_reader.h"
#include "character/package/stand_ins.h"
#include "character/pictures/picture_file.h"
#include "gltf/limits.h"
#include "rig/rig_file.h"

namespace furrow::character {
namespace {

namespace fs = std::filesystem;

int FindEmbedded(const Character& character, std::string_view name) {
  const auto& pictures = character.pictures;
  const auto found = std::find_if(pictures.begin(), pictures.end(),
                                  [&](const Picture& picture) { return picture.name == name; });
  return found == pictures.end() ? -1 : static_cast<int>(found - pictures.begin());
}

// Adds one picture of the rig, embedded or from a file, or notes it as missing. Files are
// read with Pictures::kLoad only.
Status AddRigPicture(const std::string& name, Pictures pictures, Character* character) {
  const auto& missing = character->missing_rig_pictures;
  const bool known = character->FindRigPicture(name) >= 0 ||
                     std::find(missing.begin(), missing.end(), name) != missing.end();
  if (name.empty() || known) return {};
  // Embedded pictures win over files, so that a package renders the same everywhere.
  int index = FindEmbedded(*character, name);
  if (index < 0 && pictures != Pictures::kLoad) {
    index = static_cast<int>(character->pictures.size());
    character->pictures.push_back(Undecoded(name));
  } else if (index < 0) {
    // A missing picture is noted only, because weights do not need it. A damaged picture is an
    // error.
    const Result<fs::path> path = FindAsset(name, character->folder);
    if (!path.ok() && path.status().code() == StatusCode::kNotFound) {
      character->missing_rig_pictures.push_back(name);
      return {};
    }
    FURROW_RETURN_IF_ERROR(path);
    Result<Picture> picture = LoadPicture(name, *path);
    FURROW_RETURN_IF_ERROR(picture);
    index = static_cast<int>(character->pictures.size());
    character->pictures.push_back(std::move(*picture));
  }
  character->rig_pictures.emplace_back(name, index);
  return {};
}

}  // namespace

std::vector<std::string> RigPictureNames(const wrinkle::Rig& rig) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    const bool is_new = std::find(names.begin(), names.end(), name) == names.end();
    if (!name.empty() && is_new) names.push_back(name);
  };
  for (const wrinkle::Region& region : rig.regions) {
    if (region.mask.kind == wrinkle::Mask::Kind::kTexture) add(region.mask.texture);
  }
  for (const wrinkle::WrinkleMap& map : rig.wrinkle_maps) {
    for (const std::string* name :
         {&map.normal, &map.derivative, &map.height, &map.colour, &map.cavity}) {
      add(*name);
    }
  }
  return names;
}

Result<Character> ParseCharacter(std::string_view bytes, const fs::path& folder,
                                 const ReadOptions& options) {
  Character character;
  character.folder = folder;
  FURROW_RETURN_IF_ERROR(ReadGltfCharacter(bytes, folder, options, &character));
  return character;
}

fs::path RigBeside(const fs::path& glb) { return fs::path(glb).replace_extension(".rig.json"); }

fs::path FindCharacterFile(const std::string& name_or_file) {
  return FileOrShipped(name_or_file, ".", ".glb");
}

Result<Character> LoadCharacter(const fs::path& glb, const fs::path& rig,
                                const wrinkle::PoseSource& poses, Pictures pictures) {
  const Result<std::string> bytes = ReadFile(glb, gltf::kMaxFileBytes);
  // FindCharacterFile() leaves a name that it does not know as it is.
  if (bytes.status().code() == StatusCode::kNotFound && !glb.has_parent_path()) {
    return NotShipped("character", ".", ".glb", glb.string());
  }
  FURROW_RETURN_IF_ERROR(bytes);
  Result<Character> character = ParseCharacter(*bytes, glb.parent_path(), {.pictures = pictures});
  if (!character.ok()) return character.status().Within(glb.string());
  if (character->name.empty()) character->name = glb.stem().string();

  fs::path rig_path = rig;
  if (rig.empty()) {
    rig_path = RigBeside(glb);
    std::error_code error;
    if (!fs::exists(rig_path, error)) {  // a character that does not wrinkle
      FillStandIns(&*character);
      return character;
    }
  }
  Result<wrinkle::Rig> loaded = rig::LoadRig(rig_path, poses);
  FURROW_RETURN_IF_ERROR(loaded);
  if (pictures == Pictures::kLeaveOut) {
    character->rig = std::move(*loaded);
    return character;
  }
  if (Status status = AttachRig(std::move(*loaded), rig_path.parent_path(), &*character, pictures);
      !status.ok()) {
    return status.At(rig_path.string());
  }
  FillStandIns(&*character);
  return character;
}

Result<NamedRoles> LoadCharacterRoles(const fs::path& glb) {
  const Result<std::string> bytes = ReadFile(glb, gltf::kMaxFileBytes);
  FURROW_RETURN_IF_ERROR(bytes);
  Result<NamedRoles> roles = ReadGltfRoles(*bytes, glb.parent_path());
  if (!roles.ok()) return roles.status().Within(glb.string());
  return roles;
}

Status AttachRig(wrinkle::Rig rig, const fs::path& folder, Character* character,
                 Pictures pictures) {
  character->rig = std::move(rig);
  character->folder = folder;
  character->rig_pictures.clear();
  character->missing_rig_pictures.clear();
  for (const std::string& name : RigPictureNames(character->rig)) {
    FURROW_RETURN_IF_ERROR(AddRigPicture(name, pictures, character));
  }
  return {};
}

Status SaveCharacterGlb(const Character& character, const fs::path& glb) {
  const Result<std::string> bytes = CharacterGlb(character);
  if (!bytes.ok()) return bytes.status().Within(glb.string());
  return WriteFileAtomically(glb, *bytes);
}

}  // namespace furrow::character
