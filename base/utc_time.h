// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace furrow {

// A Unix time in seconds as "2026-05-14T09:30:00Z" (RFC 3339, UTC). Times above the year 9999 give
// the last second of that year.
[[nodiscard]] std::string FormatUtc(std::uint64_t unix_seconds);
// Reads exactly that form; nullopt for other text and for dates that do not exist or precede 1970.
[[nodiscard]] std::optional<std::uint64_t> ParseUtc(std::string_view text);

// Reads a duration such as "90s", "30m", "8h" or "14d", in seconds, at least 1 s and at most 100
// years.
[[nodiscard]] std::optional<std::uint64_t> ParseDuration(std::string_view text);

}  // namespace furrow
