// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "wrinkle/status.h"

namespace furrow::character {

// Whether `name` may name a file of a package: refuses (kInvalidArgument, kLimit) empty, overlong
// and absolute names, "..", backslashes, colons and control bytes, so that a rig from outside
// reaches nothing outside its folders.
[[nodiscard]] Status CheckAssetName(std::string_view name);

// The first of `folder`/name and FURROW_ASSET_PATH's folders (colon-separated) that holds a regular
// file `name`; kNotFound lists the folders tried. Names are checked as by CheckAssetName().
[[nodiscard]] Result<std::filesystem::path> FindAsset(std::string_view name,
                                                      const std::filesystem::path& folder);

// The whole file. Errors: kNotFound, kIo (a folder, no permission), kLimit when longer than
// `max_bytes`; `where` is the path. The size is checked before anything is allocated.
[[nodiscard]] Result<std::string> ReadFile(const std::filesystem::path& path,
                                           std::size_t max_bytes);

// Writes a temporary file beside `path`, then renames it: readers see the old file or the whole new
// one, never a part. On failure (kIo) nothing is left behind.
[[nodiscard]] Status WriteFileAtomically(const std::filesystem::path& path, std::string_view bytes);

// Files that belong together: none is seen before all are on the disk, so that one that cannot be
// written leaves all as they were.
struct FileToWrite {
  std::filesystem::path path;
  std::string_view bytes;
};
[[nodiscard]] Status WriteFilesAtomically(std::span<const FileToWrite> files);

}  // namespace furrow::character
