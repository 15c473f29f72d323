// SPDX-License-Identifier: Apache-2.0
#include "report/table.h"

#include <algorithm>
#include <cstdio>

namespace furrow::report {
namespace {

// One row, padded to the widths. Missing cells stay empty.
std::string Line(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) {
  std::string line = "|";
  for (std::size_t i = 0; i < widths.size(); ++i) {
    const std::string& cell = i < cells.size() ? cells[i] : std::string();
    line += " " + cell + std::string(widths[i] - cell.size(), ' ') + " |";
  }
  return line + "\n";
}

}  // namespace

std::string ToMarkdown(const Table& table) {
  std::vector<std::size_t> widths;
  for (const std::string& cell : table.header)
    // Markdown needs at least three dashes below each header.
    widths.push_back(std::max<std::size_t>(cell.size(), 3));
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < std::min(row.size(), widths.size()); ++i) {
      widths[i] = std::max(widths[i], row[i].size());
    }
  }
  std::string text = "## " + table.title + "\n\n" + Line(table.header, widths) + "|";
  for (const std::size_t width : widths) text += std::string(width + 2, '-') + "|";
  text += "\n";
  for (const auto& row : table.rows) text += Line(row, widths);
  return text;
}

std::string Fixed(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f", digits, value);
  return text;
}

}  // namespace furrow::report
