// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>

#include "base/asset_path.h"
#include "base/status.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/pose_frame.h"

namespace furrow::rig {

// The schema of a rig: the text of rig/rig.fbs with the tables of the driver kinds inserted. Rigs
// are checked against it.
[[nodiscard]] std::string_view RigSchemaText();

// Reads a wrinkle rig (JSON, checked against rig/rig.fbs; docs/RIG.md is the manual).
//
// - The files of reference poses are searched in the rig's folder, then in the folders of
//   FURROW_ASSET_PATH. `poses` reads them (see motion/pose_source.h). If `poses` is empty, a rig
//   with such poses is kUnsupported. Mixes are resolved; poses that only mixes use are omitted.
// - Names must be unique and references must exist within the rig. RigBinding checks the joints,
//   because it knows the skeleton. Textures are not opened.
// - Errors: kNotFound, kIo, kLimit (size, depth, counts), kParse (not JSON), kSchema (unknown or
//   missing field, wrong type), kInvalidArgument (out of range, unknown name), kNonFinite,
//   kCyclic (mixes). `where` is "file:line: field" with the path of the field:
//   "drivers[3].hinge.axis".
// - `missing`: receives the names of recordings that are not found; their poses are then the rest
//   pose. Null: they are errors (kNotFound).
[[nodiscard]] Result<wrinkle::Rig> LoadRig(const std::filesystem::path& path,
                                           const wrinkle::PoseSource& poses = {},
                                           std::set<std::string>* missing = nullptr);
// `source_name`: the file name in errors. `folder`: the first folder in which files are searched.
[[nodiscard]] Result<wrinkle::Rig> ParseRig(std::string_view json, std::string_view source_name,
                                            const std::filesystem::path& folder,
                                            const wrinkle::PoseSource& poses = {},
                                            std::set<std::string>* missing = nullptr);

// The file of a rig that a user names: a file, or a shipped rig ("cmu" or "cmu.json"). See
// FileOrShipped().
[[nodiscard]] std::filesystem::path FindRigFile(const std::string& name_or_file);

// The rig as JSON that ParseRig() reads back unchanged. Reference poses are written as joints.
[[nodiscard]] std::string RigToJson(const wrinkle::Rig& rig);
// Converts a driver to JSON, to paste into `drivers` of a rig.
[[nodiscard]] std::string DriverToJson(const wrinkle::Driver& driver);
// Writes RigToJson() to a file atomically. Invalid rigs are rejected, see CheckRig().
[[nodiscard]] Status SaveRig(const wrinkle::Rig& rig, const std::filesystem::path& path);

}  // namespace furrow::rig
