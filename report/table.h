// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace furrow::report {

// Rows of text, as wide as its header.
struct Table {
  std::string title;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

// A Markdown table with aligned columns and its title as a heading.
[[nodiscard]] std::string ToMarkdown(const Table& table);

// "%.*f".
[[nodiscard]] std::string Fixed(double value, int digits);

}  // namespace furrow::report
