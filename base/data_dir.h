// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "base/status.h"

namespace furrow {

// A file of the data that the build makes (share/furrow): "default.glb", "rigs/cmu.json" ...
//
// Looked up in FURROW_DATA_DIR if it is set, else in ../share/furrow beside the running program.
// Error: kNotFound, saying where it was looked for.
[[nodiscard]] Result<std::filesystem::path> FindDataFile(std::string_view name);

}  // namespace furrow
