// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "base/status.h"

namespace furrow {

// Finds a file of the built data folder share/furrow, such as "default.glb" or "rigs/cmu.json".
//
// Searches FURROW_DATA_DIR if it is set, and otherwise ../share/furrow relative to the running
// program's folder. Error: kNotFound, with the path that was tried.
[[nodiscard]] Result<std::filesystem::path> FindDataFile(std::string_view name);

}  // namespace furrow
