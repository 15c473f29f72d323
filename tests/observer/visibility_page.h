// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

// docs/VISIBILITY.md: the visibility of the shipped folds as tables, and its comparison with a
// measurement.
namespace furrow::observer {

// A row of a table. The first columns are labels, the others are measured numbers.
struct PageRow {
  std::vector<std::string> labels;
  std::vector<std::string> cells;  // "12.3", "45%", or a word, such as "hidden"
};

struct PageTable {
  std::vector<std::string> header;
  std::vector<PageRow> rows;
};

// The page's text with each table in place of a line "<!-- table: N -->" of the template, N from 0.
// The tables keep the comment, so that they can be found again.
[[nodiscard]] std::string PageWithTables(std::string_view page,
                                         const std::vector<PageTable>& tables);

// How a page's tables differ from `tables`, one sentence each: a missing or surplus row, or a cell
// beyond the tolerance. Empty if none does.
//
// Drivers round differently. A visibility may differ by 10% and 0.5 JND, a share by 8 percentage
// points. A word must be equal.
[[nodiscard]] std::vector<std::string> DifferencesFromPage(std::string_view page,
                                                           const std::vector<PageTable>& tables);

}  // namespace furrow::observer
