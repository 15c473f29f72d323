// SPDX-License-Identifier: Apache-2.0
#include "report/bar_chart.h"

#include <algorithm>

#include "report/svg.h"
#include "report/table.h"

namespace furrow::report {
namespace {

using svg::Colour;
using svg::Rect;
using svg::Text;

// The layout in pixels.
constexpr double kLabelWidth = 300.0;
constexpr double kPlotWidth = 420.0;
constexpr double kRightMargin = 90.0;
constexpr double kFirstBarY = 62.0;
constexpr double kBar = 16.0;
constexpr double kGap = 12.0;

std::string Legend(const BarChart& chart) {
  std::string svg;
  double x = kLabelWidth;
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    svg += Rect(x, 34.0, 12.0, 12.0, Colour(i)) + Text(x + 18.0, 44.0, "start", chart.series[i]);
    // About 7 pixels per character: the text is measured only by the program that shows the
    // picture.
    x += 40.0 + 7.0 * static_cast<double>(chart.series[i].size());
  }
  return svg;
}

}  // namespace

std::string ToSvg(const BarChart& chart) {
  double largest = 0.0;
  for (const BarChart::Group& group : chart.groups) {
    for (const double value : group.values) largest = std::max(largest, value);
  }
  const double scale = largest > 0.0 ? kPlotWidth / largest : 0.0;
  std::string body = Text(12.0, 22.0, "start", chart.title + " (" + chart.unit + ")") +
                     (chart.series.size() > 1 ? Legend(chart) : std::string());
  double y = kFirstBarY;
  for (const BarChart::Group& group : chart.groups) {
    const double height = kBar * static_cast<double>(group.values.size());
    body += Text(kLabelWidth - 8.0, y + 0.5 * height + 4.0, "end", group.label);
    for (std::size_t i = 0; i < group.values.size(); ++i) {
      // A bar of 0 is still visible.
      const double width = std::max(group.values[i] * scale, 0.5);
      body += Rect(kLabelWidth, y, width, kBar - 2.0, Colour(i)) +
              Text(kLabelWidth + width + 6.0, y + 11.0, "start", svg::Short(group.values[i]));
      y += kBar;
    }
    y += kGap;
  }
  const double width = kLabelWidth + kPlotWidth + kRightMargin;
  return svg::Document(width, y, body);
}

}  // namespace furrow::report
