// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace furrow {

// Checks that `name` may name a file of a package. Rejects empty, overlong and absolute names,
// "..", backslashes, colons and control characters (kInvalidArgument, kLimit), so that an untrusted
// rig cannot reach files outside its folders.
[[nodiscard]] Status CheckAssetName(std::string_view name);

// Appends the paths of a colon-separated list, such as FURROW_ASSET_PATH. Empty ones are left out.
void AppendPaths(std::string_view list, std::vector<std::filesystem::path>* paths);

// Finds the regular file `name` in `folder`, then in the folders of FURROW_ASSET_PATH
// (colon-separated). Errors: those of CheckAssetName(), and kNotFound, which lists the folders
// searched.
[[nodiscard]] Result<std::filesystem::path> FindAsset(std::string_view name,
                                                      const std::filesystem::path& folder);

}  // namespace furrow
