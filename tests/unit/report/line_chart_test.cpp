// SPDX-License-Identifier: Apache-2.0
#include "report/line_chart.h"

#include <gtest/gtest.h>

#include "report/statistics.h"

namespace furrow::report {
namespace {

std::size_t Count(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

LineChart Chart() {
  return {.title = "latency < 1 s",
          .x = {.label = "rate"},
          .y = {.label = "ms"},
          .series = {{"p50", {{0.0, 0.0}, {10.0, 5.0}}}, {"p99", {{0.0, 1.0}, {10.0, 10.0}}}}};
}

TEST(LineChart, EndsOfTheDataAreInTheCornersOfThePlot) {
  const std::string svg = ToSvg({Chart()});
  EXPECT_EQ(Count(svg, "<polyline"), 2u);
  EXPECT_NE(svg.find("points=\"80.0,270.0 730.0,163.0 \""), std::string::npos) << svg;
  EXPECT_NE(svg.find("730.0,56.0 \""), std::string::npos) << svg;
  EXPECT_NE(svg.find("latency &lt; 1 s (ms)"), std::string::npos);
}

TEST(LineChart, LogarithmicAxisHasPowersOfTenAndNoZero) {
  LineChart chart = Chart();
  chart.series = {{"p50", {{0.0, 1.0}, {1.0, 2.0}, {10.0, 3.0}, {100.0, 4.0}}}};
  chart.x.logarithmic = true;
  const std::string svg = ToSvg({chart});
  EXPECT_NE(svg.find("points=\"80.0,163.0 405.0,109.5 730.0,56.0 \""), std::string::npos) << svg;
}

std::vector<std::string> TickLabels(const LineChart& chart, const std::string& anchor) {
  std::vector<std::string> labels;
  const std::string svg = ToSvg({chart});
  const std::string begin = "text-anchor=\"" + anchor + "\">";
  for (std::size_t at = svg.find(begin); at != std::string::npos; at = svg.find(begin, at + 1)) {
    const std::size_t from = at + begin.size();
    labels.push_back(svg.substr(from, svg.find('<', from) - from));
  }
  return labels;
}

TEST(LineChart, TicksHaveTheSameNumberOfDecimals) {
  using Labels = std::vector<std::string>;
  LineChart chart = Chart();
  chart.series = {{"p50", {{0.0, 0.0}, {1.0, 2.5}}}};
  EXPECT_EQ(TickLabels(chart, "end"), (Labels{"0.0", "0.5", "1.0", "1.5", "2.0", "2.5"}));
  chart.series = {{"p50", {{0.0, 0.0}, {1.0, 0.3}}}};
  EXPECT_EQ(TickLabels(chart, "end"),
            (Labels{"0.00", "0.05", "0.10", "0.15", "0.20", "0.25", "0.30"}));
  chart.series = {{"p50", {{0.0, 0.0}, {1.0, 400.0}}}};
  EXPECT_EQ(TickLabels(chart, "end"),
            (Labels{"0", "50", "100", "150", "200", "250", "300", "350", "400"}));
  chart.y.logarithmic = true;
  chart.series = {{"p50", {{0.0, 0.02}, {1.0, 70.0}}}};
  EXPECT_EQ(TickLabels(chart, "end"), (Labels{"0.01", "0.1", "1", "10", "100"}));
}

TEST(LineChart, PlacesChartsBelowEachOther) {
  const std::string one = ToSvg({Chart()});
  const std::string two = ToSvg({Chart(), Chart()});
  EXPECT_NE(one.find("height=\"320\""), std::string::npos);
  EXPECT_NE(two.find("height=\"640\""), std::string::npos);
  EXPECT_EQ(Count(two, "<polyline"), 4u);
}

TEST(LineChart, DrawsOnlyAxesWithoutPoints) {
  LineChart chart = Chart();
  chart.series = {{"p50", {}}};
  EXPECT_EQ(Count(ToSvg({chart}), "nan"), 0u);
}

TEST(Median, IsTheMiddleOrTheMeanOfTheMiddleTwo) {
  EXPECT_EQ(Median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(Median({4.0, 1.0, 2.0, 3.0}), 2.5);
}

}  // namespace
}  // namespace furrow::report
