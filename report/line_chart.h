// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace furrow::report {

// The label, scale and ticks of an axis.
struct Axis {
  std::string label;         // with its unit
  bool logarithmic = false;  // ticks at powers of 10; points at 0 and below are left out
  // Named ticks instead of round numbers: (value, name).
  std::vector<std::pair<double, std::string>> ticks;
};

// A chart of curves over one pair of axes. A linear axis starts at 0, or lower if there are
// negative values.
struct LineChart {
  std::string title;
  Axis x;
  Axis y;
  struct Series {
    std::string name;
    std::vector<std::pair<double, double>> points;  // x ascending
  };
  std::vector<Series> series;
};

// Returns a standalone SVG picture with all charts, one below the other.
[[nodiscard]] std::string ToSvg(const std::vector<LineChart>& charts);

}  // namespace furrow::report
