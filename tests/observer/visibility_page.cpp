// SPDX-License-Identifier: Apache-2.0
#include "tests/observer/visibility_page.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "base/joined.h"

namespace furrow::observer {
namespace {

constexpr double kVisibilityShare = 0.1;
constexpr double kVisibilityJnd = 0.5;
constexpr double kSharePoints = 8.0;

std::string Marker(std::size_t table) { return "<!-- table: " + std::to_string(table) + " -->"; }

std::string Line(const std::vector<std::string>& labels, const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const auto* list : {&labels, &cells}) {
    for (const std::string& cell : *list) line += " " + cell + " |";
  }
  return line + "\n";
}

std::string TextOf(const PageTable& table) {
  std::string text = "\n" + Line(table.header, {}) + "|";
  for (std::size_t i = 0; i < table.header.size(); ++i) text += "---|";
  text += "\n";
  for (const PageRow& row : table.rows) text += Line(row.labels, row.cells);
  return text;
}

std::vector<std::string_view> LinesOf(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::vector<std::string> CellsOf(std::string_view line) {
  std::vector<std::string> cells;
  line.remove_prefix(1);
  for (std::size_t end = line.find('|'); end != std::string_view::npos; end = line.find('|')) {
    std::string_view cell = line.substr(0, end);
    while (cell.starts_with(' ')) cell.remove_prefix(1);
    while (cell.ends_with(' ')) cell.remove_suffix(1);
    cells.emplace_back(cell);
    line.remove_prefix(end + 1);
  }
  return cells;
}

// The rows of the table behind a marker, without its header and rule.
std::vector<std::vector<std::string>> RowsOf(std::string_view page, std::size_t table) {
  std::vector<std::vector<std::string>> rows;
  const std::vector<std::string_view> lines = LinesOf(page);
  auto line = std::ranges::find(lines, Marker(table));
  while (line != lines.end() && !line->starts_with('|')) ++line;
  for (; line != lines.end() && line->starts_with('|'); ++line) rows.push_back(CellsOf(*line));
  rows.erase(rows.begin(), rows.begin() + std::min<std::ptrdiff_t>(2, std::ssize(rows)));
  return rows;
}

bool IsClose(const std::string& a, const std::string& b) {
  char* end_a = nullptr;
  char* end_b = nullptr;
  const double x = std::strtod(a.c_str(), &end_a);
  const double y = std::strtod(b.c_str(), &end_b);
  const std::string unit = end_a;
  if (end_a == a.c_str() || end_b == b.c_str() || unit != end_b) return a == b;
  const double allowed =
      unit == "%" ? kSharePoints : kVisibilityJnd + kVisibilityShare * std::abs(y);
  return std::abs(x - y) <= allowed;
}

void Compare(const PageRow& row, const std::vector<std::string>& on_page,
             const std::vector<std::string>& header, std::vector<std::string>* differences) {
  const std::size_t first = row.labels.size();
  for (std::size_t i = 0; i < row.cells.size(); ++i) {
    const std::string page_cell = first + i < on_page.size() ? on_page[first + i] : "";
    // A word beside a number follows from it, and both may lie on either side of a limit.
    if (row.cells[i] == "yes" || row.cells[i] == "no") continue;
    if (IsClose(page_cell, row.cells[i])) continue;
    differences->push_back(Joined(row.labels) + ": " + header[first + i] + " is " + row.cells[i] +
                           ", the page says '" + page_cell + "'");
  }
}

}  // namespace

std::string PageWithTables(std::string_view page, const std::vector<PageTable>& tables) {
  std::string text;
  bool in_old_table = false;
  for (const std::string_view line : LinesOf(page)) {
    // Old tables go, with the empty line before them.
    if (in_old_table && (line.empty() || line.starts_with('|'))) continue;
    if (in_old_table) text += "\n";
    in_old_table = false;
    text += std::string(line) + "\n";
    for (std::size_t i = 0; i < tables.size(); ++i) {
      if (line != Marker(i)) continue;
      text += TextOf(tables[i]);
      in_old_table = true;
    }
  }
  return text;
}

std::vector<std::string> DifferencesFromPage(std::string_view page,
                                             const std::vector<PageTable>& tables) {
  std::vector<std::string> differences;
  for (std::size_t t = 0; t < tables.size(); ++t) {
    std::map<std::vector<std::string>, std::vector<std::string>> on_page;
    for (std::vector<std::string>& cells : RowsOf(page, t)) {
      const std::size_t labels =
          tables[t].rows.empty() ? 0 : std::min(tables[t].rows[0].labels.size(), cells.size());
      std::vector<std::string> key(cells.begin(),
                                   cells.begin() + static_cast<std::ptrdiff_t>(labels));
      on_page[std::move(key)] = std::move(cells);
    }
    for (const PageRow& row : tables[t].rows) {
      const auto found = on_page.find(row.labels);
      if (found == on_page.end()) {
        differences.push_back(Joined(row.labels) + ": the page lacks the row");
        continue;
      }
      Compare(row, found->second, tables[t].header, &differences);
      on_page.erase(found);
    }
    for (const auto& [labels, cells] : on_page) {
      differences.push_back(Joined(labels) + ": the page has a row that was not measured");
    }
  }
  return differences;
}

}  // namespace furrow::observer
