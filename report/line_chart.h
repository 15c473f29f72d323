// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace furrow::report {

// Where an axis begins and how it is divided.
struct Axis {
  std::string label;         // with its unit
  bool logarithmic = false;  // tenfold steps; values of 0 and below are left out
  // Names for places on the axis instead of round numbers: (value, name).
  std::vector<std::pair<double, std::string>> ticks;
};

// Curves over one pair of axes. A linear axis begins at 0 or below.
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

// A standalone SVG picture of all charts, one below the other.
[[nodiscard]] std::string ToSvg(const std::vector<LineChart>& charts);

}  // namespace furrow::report
