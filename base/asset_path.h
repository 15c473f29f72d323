// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/status.h"

namespace furrow {

// Whether `name` may name a file of a package: refuses (kInvalidArgument, kLimit) empty, overlong
// and absolute names, "..", backslashes, colons and control bytes, so that a rig from outside
// reaches nothing outside its folders.
[[nodiscard]] Status CheckAssetName(std::string_view name);

// The first of `folder`/name and FURROW_ASSET_PATH's folders (colon-separated) that holds a regular
// file `name`; kNotFound lists the folders tried. Names are checked as by CheckAssetName().
[[nodiscard]] Result<std::filesystem::path> FindAsset(std::string_view name,
                                                      const std::filesystem::path& folder);

}  // namespace furrow
