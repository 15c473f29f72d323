// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "authoring/bake/request/bake_request.h"
#include "base/status.h"
#include "wrinkle/rig/rig.h"

namespace furrow::authoring {

// Reads strokes from a JSON file (schema: authoring/bake/strokes.fbs, manual: docs/BAKE.md).
//
// - `rig` defines the maps and regions that strokes may name. A stroke with `mirror` gives two
//   strokes, the second mirrored at the plane x = 0.
// - Errors: kNotFound and kIo (the file), kParse, kSchema, kInvalidArgument, kNonFinite, kLimit.
//   `where` is "file:line: field": "face.strokes.json:7: strokes[2].taper".
[[nodiscard]] Result<std::vector<BakeStroke>> LoadStrokes(const std::filesystem::path& path,
                                                          const wrinkle::Rig& rig);
// Parses the text of a strokes file. `source_name`: the file name in errors. Errors: those of
// LoadStrokes() except kNotFound and kIo.
[[nodiscard]] Result<std::vector<BakeStroke>> ParseStrokes(std::string_view json,
                                                           std::string_view source_name,
                                                           const wrinkle::Rig& rig);

}  // namespace furrow::authoring
