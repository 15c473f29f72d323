// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "authoring/import/model/character_check.h"
#include "base/status.h"
#include "character/character.h"
#include "character/source_notes.h"
#include "rig/shapes/shape_match.h"
#include "rig/skeleton_map.h"

namespace furrow::authoring {

// A model as it was read, including its faults.
struct OpenedModel {
  character::Character character;  // in the rest pose (BringToRestPose), otherwise as in the file
  character::SourceNotes notes;
  std::vector<std::string> remarks;  // what the conversion to glTF changed or lost
};

// Opens any skinned model and accepts faults that CheckCharacter() can report. Reads glTF 2.0
// (.glb, .gltf, .vrm, or detected by its first bytes), and other formats with assimp. Only the file
// and the pictures that it names are read. Eyeballs outside the skin of a glTF file get joints if
// `maps` know their names.
//
// Errors (`where` starts with the path): kNotFound, kIo, kLimit, kParse, kSchema, kNonFinite,
// kCyclic, kUnsupported (unknown extension).
[[nodiscard]] Result<OpenedModel> OpenModel(const std::filesystem::path& path,
                                            const rig::SkeletonMaps& maps = {});

// The options of ImportModel().
struct ModelOptions {
  bool repair = false;         // binds unskinned vertices
  std::optional<float> scale;  // metres per unit of the file; empty: derived from the height
  rig::ShapeMatcher shapes;    // shape maps that know blend shapes by other names than ARKit's
};

// A model that is ready for drawing.
struct ImportedModel {
  character::Character character;    // metres, +Y up, facing +Z; without a rig
  std::vector<std::string> remarks;  // what was changed, and what was lost
  std::vector<std::string> warnings;
  std::optional<gltf::VrmLookAt> look_at;  // of a VRM avatar's eyes, by joints
};

// Opens a model with OpenModel() and prepares it for drawing: rotates and scales it, removes
// triangles without area, and repairs it if `options` ask for it. `maps`: skeleton maps that give
// joints their roles by name. Character::roles receives the roles of FindJoints().
//
// Errors: those of OpenModel(), and kUnsupported for the first error of CheckCharacter() (no skin,
// unskinned vertices).
[[nodiscard]] Result<ImportedModel> ImportModel(const std::filesystem::path& path,
                                                const rig::SkeletonMaps& maps,
                                                const ModelOptions& options = {});

}  // namespace furrow::authoring
