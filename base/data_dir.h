// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

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

// The file that a user names: an existing file, or anything with a slash, as it is; else the
// shipped file `name` in `folder` ("." is share/furrow itself), with or without `extension`. A name
// that is neither is returned unchanged, so that the loader reports the error. A folder of the name
// does not hide the shipped file.
[[nodiscard]] std::filesystem::path FileOrShipped(const std::string& name_or_file,
                                                  std::string_view folder,
                                                  std::string_view extension);

// The files of a folder of share/furrow that end with `extension`, in order of their names. "." is
// share/furrow itself. Errors: kNotFound, kIo.
[[nodiscard]] Result<std::vector<std::filesystem::path>> ListDataFiles(std::string_view folder,
                                                                       std::string_view extension);

// The failure to find `name`: names the `kind` ("rig"), the shipped files of ListDataFiles(), and
// the one that was probably meant. Code: kNotFound.
[[nodiscard]] Status NotShipped(const std::string& kind, std::string_view folder,
                                std::string_view extension, const std::string& name);

}  // namespace furrow
