// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "authoring/bake/request/bake_request.h"
#include "base/status.h"
#include "wrinkle/rig/rig.h"

namespace furrow::authoring {

// Reads strokes from JSON. The schema is authoring/bake/strokes.fbs; docs/BAKE.md is the manual.
//
// - `rig` defines the maps and regions that strokes may name. A stroke with `mirror` gives two
//   strokes.
// - Errors: as LoadRig(). `where` is "file:line: field": "face.strokes.json:7: strokes[2].taper".
[[nodiscard]] Result<std::vector<BakeStroke>> LoadStrokes(const std::filesystem::path& path,
                                                          const wrinkle::Rig& rig);
// `source_name` replaces the file name in errors.
[[nodiscard]] Result<std::vector<BakeStroke>> ParseStrokes(std::string_view json,
                                                           std::string_view source_name,
                                                           const wrinkle::Rig& rig);

}  // namespace furrow::authoring
