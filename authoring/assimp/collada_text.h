// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace furrow::authoring {

// Collada's text without the blanks between a tag and a number. XML allows them, but assimp 5.2
// reads skin weights that follow blanks wrongly, or crashes. All other bytes stay, and so does
// UTF-16.
[[nodiscard]] std::string WithoutBlanksBeforeNumbers(std::string_view xml);

}  // namespace furrow::authoring
