// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "wrinkle/status.h"

namespace furrow::motion {

// The whole of a regular file. Errors: kNotFound, kIo,
// kLimit (more than `max_bytes`); `where` is the path.
[[nodiscard]] Result<std::string> ReadFile(const std::filesystem::path& path,
                                           std::uint64_t max_bytes);

// Writes a temporary file beside `path`, flushes it to disk and renames it: a reader sees the old
// file or the new one, never a part, and a failure (kIo) leaves nothing behind.
[[nodiscard]] Status WriteFileAtomically(const std::filesystem::path& path, std::string_view bytes);

}  // namespace furrow::motion
