// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace furrow::protocol {

// Well-formed UTF-8 (no overlong forms, no surrogates, at
// most U+10FFFF) without control characters.
[[nodiscard]] bool IsPlainText(std::string_view text);

// The longest beginning of at most `max_bytes` that does not cut a character of plain text in two.
[[nodiscard]] std::string_view PlainPrefix(std::string_view text, std::size_t max_bytes);

}  // namespace furrow::protocol
