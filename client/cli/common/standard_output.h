// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "base/status.h"

namespace furrow::cli {

// Writes all of `bytes` to standard output and flushes it. Errors: kIo.
[[nodiscard]] Status WriteStandardOutput(std::span<const std::uint8_t> bytes);

// Returns the exit code after a failed write to standard output. errno: that of the write, or 0.
// A reader that closed the pipe (`... | head`) gives kDone; any other error is printed and gives
// kFailed.
[[nodiscard]] int StandardOutputFailed();

}  // namespace furrow::cli
