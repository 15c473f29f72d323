// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "wrinkle/rig.h"
#include "wrinkle/status.h"

namespace furrow::character {

// Reads a wrinkle rig (JSON, checked against character/rig.fbs; docs/RIG.md is the manual).
//
// Reference poses that name a file and frame are loaded: beside the rig, then in the folders of
// FURROW_ASSET_PATH. Every error carries file, line and field. Textures are not opened here.
[[nodiscard]] Result<wrinkle::Rig> LoadRig(const std::filesystem::path& path);
[[nodiscard]] Result<wrinkle::Rig> ParseRig(std::string_view json, std::string_view source_name,
                                            const std::filesystem::path& folder);
// The rig as JSON that ParseRig() reads back equal; reference poses are written inline.
[[nodiscard]] std::string RigToJson(const wrinkle::Rig& rig);

// The first of `folder`/name and FURROW_ASSET_PATH's folders that holds `name`; kNotFound lists them.
// Refuses absolute names and "..": a rig from outside reaches nothing outside its folders.
[[nodiscard]] Result<std::filesystem::path> FindAsset(std::string_view name,
                                                      const std::filesystem::path& folder);

}  // namespace furrow::character
