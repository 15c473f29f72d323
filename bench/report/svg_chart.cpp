// SPDX-License-Identifier: Apache-2.0
#include "bench/report/svg_chart.h"

#include <algorithm>
#include <cmath>

#include "bench/report/table.h"

namespace furrow::bench {
namespace {

constexpr double kLabelWidth = 300.0;
constexpr double kPlotWidth = 420.0;
constexpr double kRightMargin = 90.0;
constexpr double kTop = 62.0;
constexpr double kBar = 16.0;
constexpr double kGap = 12.0;
constexpr const char* kColours[] = {"#2f6f9f", "#c8793a", "#5d8a4a", "#8a5a9a"};

std::string Escape(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&') {
      escaped += "&amp;";
    } else if (c == '<') {
      escaped += "&lt;";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string Text(double x, double y, const std::string& anchor, const std::string& text) {
  return "<text x=\"" + Fixed(x, 1) + "\" y=\"" + Fixed(y, 1) + "\" text-anchor=\"" + anchor +
         "\">" + Escape(text) + "</text>\n";
}

std::string Rect(double x, double y, double width, double height, const char* colour) {
  return "<rect x=\"" + Fixed(x, 1) + "\" y=\"" + Fixed(y, 1) + "\" width=\"" + Fixed(width, 1) +
         "\" height=\"" + Fixed(height, 1) + "\" fill=\"" + colour + "\"/>\n";
}

const char* Colour(std::size_t series) { return kColours[series % std::size(kColours)]; }

// Three figures, whatever the size.
std::string Short(double value) { return Fixed(value, value < 1.0 ? 3 : (value < 100.0 ? 1 : 0)); }

std::string Legend(const BarChart& chart) {
  std::string svg;
  double x = kLabelWidth;
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    svg += Rect(x, 34.0, 12.0, 12.0, Colour(i)) + Text(x + 18.0, 44.0, "start", chart.series[i]);
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
  double y = kTop;
  for (const BarChart::Group& group : chart.groups) {
    const double height = kBar * static_cast<double>(group.values.size());
    body += Text(kLabelWidth - 8.0, y + 0.5 * height + 4.0, "end", group.label);
    for (std::size_t i = 0; i < group.values.size(); ++i) {
      const double width = std::max(group.values[i] * scale, 0.5);
      body += Rect(kLabelWidth, y, width, kBar - 2.0, Colour(i)) +
              Text(kLabelWidth + width + 6.0, y + 11.0, "start", Short(group.values[i]));
      y += kBar;
    }
    y += kGap;
  }
  const double width = kLabelWidth + kPlotWidth + kRightMargin;
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + Fixed(width, 0) + "\" height=\"" +
         Fixed(y, 0) + "\" font-family=\"sans-serif\" font-size=\"12\">\n" +
         "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" + body + "</svg>\n";
}

}  // namespace furrow::bench
