// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace furrow::server {

// Whether clients need a token (docs/TOKENS.md).
enum class Security : std::uint8_t {
  kOpen,      // no; a token that is shown anyway is checked, and then limits its holder
  kRequired,  // yes, on every port
};

}  // namespace furrow::server
