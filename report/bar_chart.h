// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace furrow::report {

// Groups of horizontal bars. Each group has one bar per series. Lengths start at 0.
struct BarChart {
  std::string title;
  std::string unit;  // of the values; labels the axis
  std::vector<std::string> series;
  struct Group {
    std::string label;
    std::vector<double> values;  // one per series
  };
  std::vector<Group> groups;
};

// Returns a standalone SVG picture.
[[nodiscard]] std::string ToSvg(const BarChart& chart);

}  // namespace furrow::report
