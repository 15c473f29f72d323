// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "authoring/bake/bake.h"

namespace furrow::character::bake {

// Reads strokes (JSON, checked against authoring/bake/strokes.fbs; docs/BAKE.md is the manual).
//
// - `rig` knows the maps and regions that strokes may name. A stroke with `mirror` comes twice.
// - Errors: as LoadRig()'s; `where` is "file:line: field": "face.strokes.json:7: strokes[2].taper".
[[nodiscard]] Result<std::vector<BakeStroke>> LoadStrokes(const std::filesystem::path& path,
                                                          const wrinkle::Rig& rig);
// `source_name` stands for the file in errors.
[[nodiscard]] Result<std::vector<BakeStroke>> ParseStrokes(std::string_view json,
                                                           std::string_view source_name,
                                                           const wrinkle::Rig& rig);

}  // namespace furrow::character::bake
