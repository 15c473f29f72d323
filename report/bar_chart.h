// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace furrow::report {

// Groups of horizontal bars, one bar a series in each group; lengths from 0.
struct BarChart {
  std::string title;
  std::string unit;  // of the values, for the axis
  std::vector<std::string> series;
  struct Group {
    std::string label;
    std::vector<double> values;  // one a series
  };
  std::vector<Group> groups;
};

// A standalone SVG picture.
[[nodiscard]] std::string ToSvg(const BarChart& chart);

}  // namespace furrow::report
