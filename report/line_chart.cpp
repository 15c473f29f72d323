// SPDX-License-Identifier: Apache-2.0
#include "report/line_chart.h"

#include <algorithm>
#include <cmath>

#include "report/svg.h"
#include "report/table.h"

namespace furrow::report {
namespace {

// The layout of one chart in pixels; charts stand below each other.
constexpr double kWidth = 760.0;
constexpr double kHeight = 320.0;
constexpr double kLeft = 80.0;
constexpr double kRight = 730.0;
constexpr double kTop = 56.0;
constexpr double kBottom = 270.0;
constexpr const char* kGrid = "#dddddd";

// Number of decimals that 1, 2 or 5 times a power of ten needs.
int DigitsOf(double step) {
  return std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
}

// Maps values to pixels along one axis.
class Scale {
 public:
  Scale(const Axis& axis, double low, double high, double from, double to)
      : logarithmic_(axis.logarithmic), from_(from), to_(to) {
    low_ = logarithmic_ ? std::floor(std::log10(low)) : std::min(low, 0.0);
    high_ = logarithmic_ ? std::ceil(std::log10(high)) : high;
    // A range of one value would divide by 0.
    if (high_ <= low_) high_ = low_ + 1.0;
  }

  [[nodiscard]] bool Has(double value) const { return !logarithmic_ || value > 0.0; }
  [[nodiscard]] double operator()(double value) const {
    const double place = logarithmic_ ? std::log10(value) : value;
    return from_ + (to_ - from_) * (place - low_) / (high_ - low_);
  }

  // Logarithmic: powers of ten. Linear: about five steps of 1, 2 or 5 times a power of ten, all
  // written with the same number of decimals.
  [[nodiscard]] std::vector<std::pair<double, std::string>> Ticks() const {
    std::vector<std::pair<double, std::string>> ticks;
    if (logarithmic_) {
      for (double power = low_; power <= high_; power += 1.0) {
        const double value = std::pow(10.0, power);
        ticks.emplace_back(value, Fixed(value, DigitsOf(value)));
      }
      return ticks;
    }
    const double rough = (high_ - low_) / 5.0;
    double step = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {5.0, 2.0}) {
      if (step * factor <= rough) {
        step *= factor;
        break;
      }
    }
    const double first = std::ceil(low_ / step);
    // Multiplies instead of adding the step up, so that ticks are exact. The tolerance keeps the
    // last one.
    for (double i = first; i * step <= high_ + 1e-9 * step; i += 1.0)
      ticks.emplace_back(i * step, Fixed(i * step, DigitsOf(step)));
    return ticks;
  }

 private:
  bool logarithmic_;
  double from_;
  double to_;
  double low_;
  double high_;
};

struct Range {
  double low = 0.0;
  double high = 0.0;
  bool any = false;
  void Add(double value) {
    low = any ? std::min(low, value) : value;
    high = any ? std::max(high, value) : value;
    any = true;
  }
};

// The scale that shows all points of all series.
Scale MakeScale(const LineChart& chart, const Axis& axis, bool is_x, double from, double to) {
  Range range;
  for (const LineChart::Series& series : chart.series) {
    for (const auto& [x, y] : series.points) {
      const double value = is_x ? x : y;
      if (!axis.logarithmic || value > 0.0) range.Add(value);
    }
  }
  // A chart without points still has axes.
  if (!range.any) range.Add(1.0);
  return {axis, range.low, range.high, from, to};
}

std::string Grid(const LineChart& chart, const Scale& x, const Scale& y, double top) {
  std::string svg;
  for (const auto& [value, name] : chart.x.ticks.empty() ? x.Ticks() : chart.x.ticks) {
    svg += svg::Line(x(value), top + kTop, x(value), top + kBottom, kGrid) +
           svg::Text(x(value), top + kBottom + 16.0, "middle", name);
  }
  for (const auto& [value, name] : chart.y.ticks.empty() ? y.Ticks() : chart.y.ticks) {
    svg += svg::Line(kLeft, y(value), kRight, y(value), kGrid) +
           svg::Text(kLeft - 6.0, y(value) + 4.0, "end", name);
  }
  return svg;
}

std::string Draw(const LineChart& chart, double top) {
  const Scale x = MakeScale(chart, chart.x, true, kLeft, kRight);
  // Pixels grow downwards, so the axis runs from the bottom up.
  const Scale y = MakeScale(chart, chart.y, false, top + kBottom, top + kTop);
  std::string svg =
      svg::Text(12.0, top + 20.0, "start", chart.title + " (" + chart.y.label + ")") +
      Grid(chart, x, y, top) +
      svg::Text(0.5 * (kLeft + kRight), top + kBottom + 36.0, "middle", chart.x.label);
  double legend = kLeft;
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const LineChart::Series& series = chart.series[i];
    std::vector<std::pair<double, double>> points;
    for (const auto& [px, py] : series.points) {
      if (x.Has(px) && y.Has(py)) points.emplace_back(x(px), y(py));
    }
    svg += svg::Polyline(points, svg::Colour(i)) +
           svg::Rect(legend, top + 32.0, 12.0, 12.0, svg::Colour(i)) +
           svg::Text(legend + 18.0, top + 42.0, "start", series.name);
    legend += 40.0 + 7.0 * static_cast<double>(series.name.size());
  }
  return svg;
}

}  // namespace

std::string ToSvg(const std::vector<LineChart>& charts) {
  std::string body;
  double top = 0.0;
  for (const LineChart& chart : charts) {
    body += Draw(chart, top);
    top += kHeight;
  }
  return svg::Document(kWidth, top, body);
}

}  // namespace furrow::report
