// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace furrow::protocol {

// Well-formed UTF-8 (no overlong forms, no surrogates, at most U+10FFFF) without control
// characters.
[[nodiscard]] bool IsPlainText(std::string_view text);

}  // namespace furrow::protocol
