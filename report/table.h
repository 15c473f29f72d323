// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace furrow::report {

// A table of text. Each row has one cell per column of the header; missing cells are left blank.
struct Table {
  std::string title;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

// Returns a Markdown table with aligned columns, below its title as a heading.
[[nodiscard]] std::string ToMarkdown(const Table& table);

// Formats a number with `digits` decimals.
[[nodiscard]] std::string Fixed(double value, int digits);

}  // namespace furrow::report
