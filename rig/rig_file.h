// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/asset_path.h"
#include "base/status.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/pose_frame.h"

namespace furrow::character {

// The text of rig/rig.fbs, which rigs are checked against.
[[nodiscard]] std::string_view RigSchemaText();

// Reads a wrinkle rig (JSON, checked against rig/rig.fbs; docs/RIG.md is the manual).
//
// - Reference poses that name a file and frame are looked up beside the rig, then in the folders of
//   FURROW_ASSET_PATH, and read by `poses` (see motion/pose_source.h). Without a source such a
//   rig is kUnsupported. Mixes are resolved; a pose that only mixes use is left out.
// - Names are checked within the rig: unique, and what refers to them exists. Joints are not: that
//   is RigBinding's, once a skeleton is known. Textures are not opened.
// - Errors: kNotFound, kIo, kLimit (size, depth, counts), kParse (not JSON), kSchema (a field
//   unknown, missing or of the wrong type), kInvalidArgument (out of range, unknown name),
//   kNonFinite, kCyclic (mixes). `where` is "file:line: field", the field as a path:
//   "drivers[3].hinge.axis".
[[nodiscard]] Result<wrinkle::Rig> LoadRig(const std::filesystem::path& path,
                                           const wrinkle::PoseSource& poses = {});
// `source_name` stands for the file in errors; `folder` is where files are looked up first.
[[nodiscard]] Result<wrinkle::Rig> ParseRig(std::string_view json, std::string_view source_name,
                                            const std::filesystem::path& folder,
                                            const wrinkle::PoseSource& poses = {});

// The rig as JSON that ParseRig() reads back equal; reference poses are written inline.
[[nodiscard]] std::string RigToJson(const wrinkle::Rig& rig);
// One entry of `drivers`, to be pasted into a rig.
[[nodiscard]] std::string DriverToJson(const wrinkle::Driver& driver);
// RigToJson() into a file, atomically.
[[nodiscard]] Status SaveRig(const wrinkle::Rig& rig, const std::filesystem::path& path);

}  // namespace furrow::character
