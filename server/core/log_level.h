// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace furrow::server {

// The least important lines that the log shows.
enum class LogLevel : std::uint8_t { kError, kWarning, kInfo };

// "error", "warning" or "info"; nullopt for other text.
[[nodiscard]] inline std::optional<LogLevel> ParseLogLevel(std::string_view word) {
  if (word == "error") return LogLevel::kError;
  if (word == "warning") return LogLevel::kWarning;
  if (word == "info") return LogLevel::kInfo;
  return std::nullopt;
}

[[nodiscard]] inline std::string_view LogLevelText(LogLevel level) {
  switch (level) {
    case LogLevel::kError: return "error";
    case LogLevel::kWarning: return "warning";
    case LogLevel::kInfo: break;
  }
  return "info";
}

}  // namespace furrow::server
