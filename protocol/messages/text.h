// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace furrow::protocol {

// True for well-formed UTF-8 (no overlong forms, no surrogates, at most U+10FFFF) without control
// characters (below 0x20, and 0x7F).
[[nodiscard]] bool IsPlainText(std::string_view text);

// Returns the longest prefix of at most `max_bytes` that does not split a UTF-8 character. The
// result refers to `text`. Precondition: IsPlainText(text).
[[nodiscard]] std::string_view PlainPrefix(std::string_view text, std::size_t max_bytes);

}  // namespace furrow::protocol
