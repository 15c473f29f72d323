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

// Whether WriteFile() may be expected to succeed: asked before work that takes long. What is there
// stays as it is; kIo names the file and says why not.
[[nodiscard]] Status CheckWritable(const std::filesystem::path& path);

// Writes to standard output and flushes; kIo says why it could not.
[[nodiscard]] Status WriteStandardOutput(std::span<const std::uint8_t> bytes);

// What to exit with just after standard output took no more (errno says why): kDone where its
// reader has had enough (`... | head`), else the reason is printed and it is kFailed.
[[nodiscard]] int StandardOutputFailed();

}  // namespace furrow::cli
