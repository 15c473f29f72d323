// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace furrow::server {

// Whether clients need a token (docs/TOKENS.md).
enum class Security : std::uint8_t {
  kOpen,      // no; a token that is shown anyway is checked, and then limits its holder
  kRequired,  // yes, on every port
};

// "open" or "required"; nullopt for other text.
[[nodiscard]] inline std::optional<Security> ParseSecurity(std::string_view word) {
  if (word == "open") return Security::kOpen;
  if (word == "required") return Security::kRequired;
  return std::nullopt;
}

}  // namespace furrow::server
