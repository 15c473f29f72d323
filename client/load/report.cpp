// SPDX-License-Identifier: Apache-2.0
#include "client/load/report.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "report/line_chart.h"
#include "report/table.h"
#include "report/words.h"

namespace furrow::load {
namespace {

using furrow::report::Axis;
using furrow::report::Counted;
using furrow::report::Fixed;
using furrow::report::LineChart;
using furrow::report::Table;

std::string Count(std::uint64_t value) { return std::to_string(value); }

std::string Mebibytes(std::uint64_t bytes) {
  return Fixed(static_cast<double>(bytes) / (1 << 20), 1) + " MiB";
}

// What makes the figures say less than they seem to.
std::string Remarks(const RunResult& result, const RunOptions& options) {
  std::string text;
  const auto remark = [&text](const std::string& sentence) { text += sentence + "\n"; };
  if (result.interrupted) remark("Interrupted: this is the run so far.");
  if (result.ended_early) {
    remark("Ended before its time: " + result.complaint + ".");
  } else if (!result.complaint.empty()) {
    remark("Said meanwhile: " + result.complaint + ".");
  }
  if (result.tally.sent < result.tally.offered) {
    remark(Counted(result.tally.offered - result.tally.sent, "pose") +
           " did not leave when due: the system took no more datagrams. None is among the lost.");
  }
  if (!result.checked_names && options.check_weights)
    remark("Weights were not checked: the daemon's are named otherwise than those of --rig.");
  if (result.tally.unfollowed > 0) {
    remark(Counted(result.tally.unfollowed, "pose") +
           " had weights that differ from the solver's, too many to be followed up: counted as not "
           "to be checked.");
  }
  if (result.overrun > 0) {
    remark("This program's own buffers lost " + Counted(result.overrun, "datagram") +
           ": it is too slow for this rate.");
  }
  if (result.burdens_cut > 0) {
    remark("The daemon cut off slow or stalled subscribers " + Counted(result.burdens_cut, "time") +
           "; they came back.");
  }
  if (options.burdens.churn > 0) {
    remark("Churning subscribers left and came back " + Counted(result.churn_returns, "time") +
           ".");
  }
  if (result.usage_unknown) {
    remark(
        "The daemon's processor time and memory are not known: which process it is was not found, "
        "or is not to be asked. Name it by --pid.");
  }
  if (result.tally.early > 0) {
    remark("Before their pose was due came the weights of " + Counted(result.tally.early, "pose") +
           ", by this machine's clocks, which were set or disagree: counted as 0 ms.");
  }
  const double behind_us = static_cast<double>(result.send_delay_ns.Percentile(99.0)) * 1e-3;
  if (behind_us > 0.25 * result.p(99.0)) {
    remark("This program sent poses up to " + Fixed(behind_us, 0) +
           " us late (p99), which counts as latency: it, or the machine, is busy.");
  }
  return text;
}

LineChart ByPercentile(const RunResult& result) {
  LineChart chart{.title = "Latency by percentile",
                  .x = {.label = "percentile", .logarithmic = true, .ticks = {}},
                  .y = {.label = "ms", .logarithmic = false, .ticks = {}},
                  .series = {{"pose due to weights here", {}}}};
  for (const double nines : {50.0, 90.0, 99.0, 99.9, 99.99})
    chart.x.ticks.emplace_back(100.0 / (100.0 - nines), furrow::report::Fixed(nines, 2) + "%");
  const auto count = static_cast<double>(std::max<std::uint64_t>(result.latency_ns.count(), 1));
  for (double inverse = 1.0; inverse <= std::min(count, 1e4); inverse *= 1.1) {
    chart.series[0].points.emplace_back(inverse, result.p(100.0 - 100.0 / inverse) * 1e-3);
  }
  return chart;
}

// p99 on top of max: in short windows they are the same.
LineChart OverTime(const RunResult& result) {
  LineChart chart{.title = "Latency over time",
                  .x = {.label = "seconds since the start", .logarithmic = false, .ticks = {}},
                  .y = {.label = "ms", .logarithmic = false, .ticks = {}},
                  .series = {{"p50", {}}, {"max", {}}, {"p99", {}}}};
  for (std::size_t i = 0; i < result.windows.size(); ++i) {
    const Histogram& window = result.windows[i];
    if (window.count() == 0) continue;
    const double at = result.planned_seconds * (static_cast<double>(i) + 0.5) /
                      static_cast<double>(result.windows.size());
    const double values[] = {static_cast<double>(window.Percentile(50.0)),
                             static_cast<double>(window.max()),
                             static_cast<double>(window.Percentile(99.0))};
    for (std::size_t s = 0; s < 3; ++s) chart.series[s].points.emplace_back(at, values[s] * 1e-6);
  }
  return chart;
}

std::vector<LineChart> ByRate(std::vector<RateStep> steps) {
  std::ranges::sort(steps, {}, &RateStep::rate);
  const Axis rate{.label = "poses a second", .logarithmic = false, .ticks = {}};
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

nlohmann::json CountsOf(const RunResult& result) {
  const Tally& tally = result.tally;
  return {{"offered", tally.offered},
          {"sent", tally.sent},
          {"expected", tally.expected},
          {"received", tally.received},
          {"lost", tally.lost()},
          {"late", tally.late},
          {"early", tally.early},
          {"wrong", tally.wrong},
          {"swapped", tally.swapped},
          {"falsified", tally.falsified()},
          {"unclassified", tally.unclassified},
          {"reordered", tally.reordered},
          {"duplicates", tally.duplicates},
          {"never_sent", tally.never_sent},
          {"malformed", result.malformed},
          {"checked", tally.checked},
          {"unchecked", tally.unchecked},
          {"unfollowed", tally.unfollowed},
          {"overrun", result.overrun},
          {"churn_returns", result.churn_returns},
          {"burdens_cut", result.burdens_cut}};
}

}  // namespace

std::string LiveLine(double seconds, const Tally& tally, const Histogram& latency_ns) {
  const auto milliseconds = [&](double percentile) {
    return Fixed(static_cast<double>(latency_ns.Percentile(percentile)) * 1e-6, 3);
  };
  return Fixed(seconds, 0) + " s: sent " + Count(tally.sent) + ", received " +
         Count(tally.received) + ", under way or lost " + Count(tally.lost()) + ", late " +
         Count(tally.late) + "; p50 " + milliseconds(50.0) + " ms, p99 " + milliseconds(99.0) +
         " ms";
}

std::string ToText(const RunResult& result, const RunOptions& options) {
  const Tally& tally = result.tally;
  Table poses{
      "Poses and weights",
      {"offered", "sent", "expected", "received", "lost", "late", "wrong", "reordered", "twice",
       "never sent", "undecodable"},
      {{Count(tally.offered), Count(tally.sent), Count(tally.expected), Count(tally.received),
        Count(tally.lost()), Count(tally.late), Count(tally.wrong), Count(tally.reordered),
        Count(tally.duplicates), Count(tally.never_sent), Count(result.malformed)}}};
  Table latency{"Latency, ms, from when a pose was due to when its weights were here",
                {"p50", "p90", "p99", "p99.9", "max", "late to send, p99"},
                {{}}};
  for (const double percentile : {50.0, 90.0, 99.0, 99.9, 100.0})
    latency.rows[0].push_back(Fixed(result.p(percentile) * 1e-3, 3));
  latency.rows[0].push_back(
      Fixed(static_cast<double>(result.send_delay_ns.Percentile(99.0)) * 1e-6, 3));
  std::string text = ToMarkdown(poses) + "\n" + ToMarkdown(latency) + "\n";
  if (result.usage && result.cpu_seconds) {
    const Table usage{
        "The daemon",
        {"CPU, % of a core", "us a pose", "memory", "at most"},
        {{Fixed(100.0 * *result.cpu_seconds / std::max(result.seconds, 1e-3), 1),
          Fixed(result.cpu_us_per_pose().value_or(0.0), 2), Mebibytes(result.usage->resident_bytes),
          Mebibytes(result.usage->peak_resident_bytes)}}};
    text += ToMarkdown(usage) + "\n";
  }
  text += "Weights checked against the solver: " + Count(tally.checked) + ", to " +
          Fixed(options.tolerance, 6) + "; largest difference of the right ones " +
          Fixed(tally.largest_difference, 7) + "; not to be checked: " + Count(tally.unchecked) +
          ".\n";
  if (tally.wrong > 0) {
    text +=
        "Of the wrong, " + Count(tally.swapped) + " are another pose's or subject's (swapped), " +
        Count(tally.falsified()) + " nobody's (falsified)" +
        (tally.unclassified > 0 ? ", " + Count(tally.unclassified) + " were not looked for" : "") +
        ".\n";
  }
  return text + Remarks(result, options);
}

nlohmann::json ToJson(const RunResult& result) {
  nlohmann::json json = CountsOf(result);
  json["seconds"] = result.seconds;
  json["poses_per_second"] = result.planned_rate;
  json["largest_difference"] = result.tally.largest_difference;
  json["interrupted"] = result.interrupted;
  json["ended_early"] = result.ended_early;
  json["complaint"] = result.complaint;
  json["latency_us"] = {{"p50", result.p(50.0)},
                        {"p90", result.p(90.0)},
                        {"p99", result.p(99.0)},
                        {"p99.9", result.p(99.9)},
                        {"max", result.p(100.0)}};
  json["send_delay_p99_us"] = static_cast<double>(result.send_delay_ns.Percentile(99.0)) * 1e-3;
  if (result.cpu_seconds) {
    json["cpu_seconds"] = *result.cpu_seconds;
    json["cpu_us_per_pose"] = result.cpu_us_per_pose().value_or(0.0);
  }
  if (result.usage) {
    json["resident_bytes"] = result.usage->resident_bytes;
    json["peak_resident_bytes"] = result.usage->peak_resident_bytes;
  }
  return json;
}

std::string Plot(const RunResult& result, const std::vector<RateStep>& steps) {
  std::vector<LineChart> charts;
  if (result.latency_ns.count() > 0) charts = {ByPercentile(result), OverTime(result)};
  if (!steps.empty()) {
    for (LineChart& chart : ByRate(steps)) charts.push_back(std::move(chart));
  }
  return furrow::report::ToSvg(charts);
}

}  // namespace furrow::load
