// SPDX-License-Identifier: Apache-2.0
#include "client/load/report/plot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "report/line_chart.h"
#include "report/table.h"

namespace furrow::load {
namespace {

using furrow::report::Axis;
using furrow::report::LineChart;

LineChart ByPercentile(const RunResult& result) {
  LineChart chart{.title = "Latency by percentile",
                  .x = {.label = "percentile", .logarithmic = true, .ticks = {}},
                  .y = {.label = "ms", .logarithmic = false, .ticks = {}},
                  .series = {{"pose due to weights received", {}}}};
  for (const double nines : {50.0, 90.0, 99.0, 99.9, 99.99})
    chart.x.ticks.emplace_back(100.0 / (100.0 - nines), report::Fixed(nines, 2) + "%");
  const auto count = static_cast<double>(std::max<std::uint64_t>(result.latency_ns.count(), 1));
  // The axis is 1 / (1 - percentile), which gives each further nine as much room as the one before.
  // Beyond the number of samples there is nothing to show.
  for (double inverse = 1.0; inverse <= std::min(count, 1e4); inverse *= 1.1) {
    chart.series[0].points.emplace_back(inverse, result.p(100.0 - 100.0 / inverse) * 1e-3);
  }
  return chart;
}

// Draws p99 over max, because the two coincide in short windows.
LineChart OverTime(const RunResult& result) {
  LineChart chart{.title = "Latency over time",
                  .x = {.label = "seconds since the start", .logarithmic = false, .ticks = {}},
                  .y = {.label = "ms", .logarithmic = false, .ticks = {}},
                  .series = {{"p50", {}}, {"max", {}}, {"p99", {}}}};
  for (std::size_t i = 0; i < result.windows.size(); ++i) {
    const Histogram& window = result.windows[i];
    if (window.count() == 0) continue;
    // The middle of the window.
    const double at = result.planned_seconds * (static_cast<double>(i) + 0.5) /
                      static_cast<double>(result.windows.size());
    const double values[] = {static_cast<double>(window.Percentile(50.0)),
                             static_cast<double>(window.max()),
                             static_cast<double>(window.Percentile(99.0))};
    for (std::size_t s = 0; s < 3; ++s) chart.series[s].points.emplace_back(at, values[s] * 1e-6);
  }
  return chart;
}

// Searches try rates in no order, and a curve needs them ascending.
std::vector<LineChart> ByRate(std::vector<RateStep> steps) {
  std::ranges::sort(steps, {}, &RateStep::rate);
  const Axis rate{.label = "poses per second", .logarithmic = false, .ticks = {}};
  LineChart latency{.title = "Latency by rate",
                    .x = rate,
                    .y = {.label = "ms", .logarithmic = true, .ticks = {}},
                    .series = {{"p50", {}}, {"p99", {}}}};
  LineChart loss{.title = "Loss by rate",
                 .x = rate,
                 .y = {.label = "% of the weights", .logarithmic = false, .ticks = {}},
                 .series = {{"lost", {}}}};
  for (const RateStep& step : steps) {
    latency.series[0].points.emplace_back(step.rate, step.p50_us * 1e-3);
    latency.series[1].points.emplace_back(step.rate, step.p99_us * 1e-3);
    loss.series[0].points.emplace_back(step.rate, 100.0 * step.lost_share);
  }
  return {latency, loss};
}

}  // namespace

std::string Plot(const RunResult& result, const std::vector<RateStep>& steps) {
  std::vector<LineChart> charts;
  if (result.latency_ns.count() > 0) charts = {ByPercentile(result), OverTime(result)};
  if (!steps.empty()) {
    for (LineChart& chart : ByRate(steps)) charts.push_back(std::move(chart));
  }
  return furrow::report::ToSvg(charts);
}

}  // namespace furrow::load
