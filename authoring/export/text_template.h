// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace furrow::authoring {

// The values of a template: texts, and lists of further values.
struct TemplateData {
  std::map<std::string, std::string> texts;
  std::map<std::string, std::vector<TemplateData>> lists;
};

// Expands a text, line by line:
//
// - `@{name}` becomes a text. Within a list, the texts of the entry come before those around it.
// - The lines from one with `@each name` to its `@end` are repeated for each entry of a list.
// - The lines from one with `@if name` to its `@end` are kept if the text is not empty, or the list
//   has entries; `@unless name` is the opposite.
//
// A line with a directive holds nothing else except the comment signs of the language ("//", "#",
// "<!--", "-->") and is not copied. Blocks may be nested. `name` is the file's, for messages.
// Errors: kParse (an unknown name, an unfinished block), with file and line.
[[nodiscard]] Result<std::string> ExpandTemplate(std::string_view text, const TemplateData& data,
                                                 std::string_view name);

}  // namespace furrow::authoring
