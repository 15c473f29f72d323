// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "base/status.h"

namespace furrow::cli {

// Writes to standard output and flushes; kIo says why it could not.
[[nodiscard]] Status WriteStandardOutput(std::span<const std::uint8_t> bytes);

// What to exit with just after standard output took no more (errno says why): kDone where its
// reader has had enough (`... | head`), else the reason is printed and it is kFailed.
[[nodiscard]] int StandardOutputFailed();

}  // namespace furrow::cli
