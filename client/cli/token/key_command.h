// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/cli/common/command.h"

namespace furrow::cli {

// Adds `key` with its commands new, list and retire to the command `token`.
void AddTokenKey(CLI::App& token, Action& action);

// The help text of --key.
inline constexpr char kKeyFileHelp[] = "File with the keys that seal tokens";

// Unix time in seconds.
[[nodiscard]] std::uint64_t UnixNow();

// A validator for durations such as 90s, 30m, 8h, 14d (ParseDuration).
[[nodiscard]] CLI::Validator DurationValidator();

// "in 7 h 59 min", "in 12 days", "expired".
[[nodiscard]] std::string RemainingText(std::uint64_t expires, std::uint64_t now);

}  // namespace furrow::cli
