// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "authoring/export/engine.h"
#include "base/status.h"
#include "character/character.h"
#include "rig/exports/export_profile.h"

namespace furrow::authoring {

struct ExportOptions {
  Engine engine = Engine::kGeneric;
  std::optional<int> bits;  // of normal maps, 8 or 16; nothing: the engine's default
  // Derivative maps beside the normal maps, with 16 bits unless `bits` says otherwise.
  bool derivatives = false;
  std::string generator;  // what wrote the export: "furrow 0.1.0"
  // Profiles whose names wrinkles.json lists. The rig's own exports are listed in any case.
  std::span<const rig::ExportProfile> profiles;
};

// An export as files for one folder.
struct ExportedFiles {
  std::vector<std::string> names;  // in the order in which they were written
  std::vector<std::string> notes;  // what is left out, and why; one sentence each
};

// Receives a file of the export; `name` may contain a folder. An error ends the export.
using FileSink = std::function<Status(const std::string& name, std::string_view bytes)>;

// Writes a character's wrinkles for an engine: textures/, shaders/, wrinkles.json and README.md.
//
// - Each wrinkle map becomes a tangent-space normal map in the engine's convention.
// - Heights, colours and cavities are written if the character has them.
// - Masks are packed four to a picture.
// - Equal inputs give equal files.
//
// Errors: those of PlanExport() and EncodePng(), kInvalidArgument (two weights that share a
// parameter name), and those of `write`.
[[nodiscard]] Result<ExportedFiles> ExportCharacter(const character::Character& character,
                                                    const ExportOptions& options,
                                                    const FileSink& write);

}  // namespace furrow::authoring
