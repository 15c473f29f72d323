// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "authoring/import/model/character_check.h"
#include "base/status.h"
#include "character/character.h"
#include "rig/skeleton_map.h"

namespace furrow::authoring {

// A model as it was read, with all that is wrong with it.
struct OpenedModel {
  character::Character
      character;  // in the rest pose (BringToRestPose), otherwise as the file has it
  character::SourceNotes notes;
  std::vector<std::string> remarks;  // of a converter
};

// Opens any skinned model leniently: glTF 2.0 (.glb, .gltf, .vrm, or by its first bytes) through
// the reader of characters, everything else through assimp. Nothing but the file itself and the
// pictures beside it that it names is read.
//
// Errors, whose `where` begins with the path: kNotFound, kIo, kLimit, kParse, kSchema, kNonFinite,
// kCyclic, kUnsupported (an extension that nobody reads).
[[nodiscard]] Result<OpenedModel> OpenModel(const std::filesystem::path& path);

struct ModelOptions {
  bool repair = false;         // leaves out degenerate triangles and binds unskinned vertices
  std::optional<float> scale;  // metres in the file's unit; none: told from the height
};

struct ImportedModel {
  character::Character character;    // metres, +Y up, facing +Z; without a rig
  std::vector<std::string> remarks;  // what was changed, what is not carried
  std::vector<std::string> warnings;
};

// OpenModel(), then made fit to be drawn: turned, scaled, and repaired where `options` say so.
//
// Errors: OpenModel()'s, and kUnsupported for the first error that CheckCharacter() finds: no skin,
// no UVs, unskinned vertices, degenerate triangles.
[[nodiscard]] Result<ImportedModel> ImportModel(const std::filesystem::path& path,
                                                const character::SkeletonMaps& maps,
                                                const ModelOptions& options = {});

}  // namespace furrow::authoring
