// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "wrinkle/status.h"

namespace furrow::cli {

// Writes a whole file; kIo names it.
[[nodiscard]] Status WriteFile(const std::filesystem::path& path,
                               std::span<const std::uint8_t> bytes);

// Writes to standard output and flushes; kIo when it is closed.
[[nodiscard]] Status WriteStandardOutput(std::span<const std::uint8_t> bytes);

}  // namespace furrow::cli
