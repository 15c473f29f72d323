// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/character_package.h"

#include <string>

#include "base/files.h"
#include "character/package/package.h"
#include "rig/rig_check.h"
#include "rig/rig_file.h"

namespace furrow::authoring {

Status WriteCharacterPackage(const character::Character& character,
                             const std::filesystem::path& glb) {
  const std::filesystem::path rig = character::RigBeside(glb);
  if (const Status s = rig::CheckRig(character.rig); !s.ok()) return s.Within(rig.string());
  const Result<std::string> bytes = character::CharacterGlb(character);
  if (!bytes.ok()) return bytes.status().Within(glb.string());
  const std::string json = rig::RigToJson(character.rig);
  const FileToWrite files[] = {{glb, *bytes}, {rig, json}};
  return WriteFilesAtomically(files);
}

}  // namespace furrow::authoring
