// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "tests/unit/protocol/drill.h"

namespace furrow::protocol::test {

// Converts "2F56 4D" to bytes. Ignores spaces.
[[nodiscard]] inline Bytes FromHex(std::string_view text) {
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'A' + 10; };
  Bytes bytes;
  int high = -1;
  for (const char c : text) {
    if (c == ' ') continue;
    if (high < 0) {
      high = digit(c);
    } else {
      bytes.push_back(static_cast<std::uint8_t>(high * 16 + digit(c)));
      high = -1;
    }
  }
  return bytes;
}

}  // namespace furrow::protocol::test
