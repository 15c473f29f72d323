// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace furrow::report {

// A chart of horizontal bars in groups. Each group has one bar per series. Bars start at 0.
struct BarChart {
  std::string title;
  std::string unit;                 // of the values; labels the axis
  std::vector<std::string> series;  // names, for the legend
  struct Group {
    std::string label;
    std::vector<double> values;  // one per series, >= 0
  };
  std::vector<Group> groups;
};

// Returns the chart as a standalone SVG picture.
[[nodiscard]] std::string ToSvg(const BarChart& chart);

}  // namespace furrow::report
