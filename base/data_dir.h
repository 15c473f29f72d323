// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "base/status.h"

namespace furrow {

// The folder above bin/, lib/ and share/: build/<preset>, or where Furrow is installed. It follows
// the running program, in bin/ or libexec/furrow/, so an installation may be moved.
[[nodiscard]] std::filesystem::path InstallPrefix();
// The same for a program in `folder`.
[[nodiscard]] std::filesystem::path InstallPrefix(const std::filesystem::path& folder);

// Finds a file of the built data folder share/furrow, such as "default.glb" or "rigs/cmu.json".
//
// Searches FURROW_DATA_DIR if it is set, and otherwise share/furrow in InstallPrefix().
// Error: kNotFound, with the path that was tried.
[[nodiscard]] Result<std::filesystem::path> FindDataFile(std::string_view name);

}  // namespace furrow
