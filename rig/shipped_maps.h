// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "base/status.h"

// Skeleton maps and shape maps are files that ship in folders of Furrow's data.
namespace furrow::rig {

// The file of a map: `name_or_file` if it is a file or has a slash, else the shipped map of that
// name in `folder`. Error: kNotFound (no shipped map has this name).
[[nodiscard]] Result<std::filesystem::path> FindMap(const std::string& folder,
                                                    const std::string& name_or_file);

}  // namespace furrow::rig
