// SPDX-License-Identifier: Apache-2.0
#include "bench/load/curves.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "bench/load/variants.h"
#include "bench/report/value_or_exit.h"
#include "client/load/report/run_report.h"
#include "report/line_chart.h"
#include "report/table.h"

namespace furrow::bench {
namespace {

using report::Fixed;
using report::LineChart;

constexpr int kCrowd = 100;  // subjects, while another quantity grows

void Add(Curve& curve, double x, load::RunResult run) {
  std::fprintf(stderr, "%s: %.0f\n", curve.id.c_str(), x);
  curve.points.push_back({x, std::move(run)});
}

double CorePercent(const load::RunResult& run) {
  return run.cpu_seconds ? 100.0 * *run.cpu_seconds / run.seconds : 0.0;
}

double Mebibytes(const load::RunResult& run) {
  return run.usage ? static_cast<double>(run.usage->resident_bytes) / (1 << 20) : 0.0;
}

double LostPercent(const load::RunResult& run) {
  return 100.0 * static_cast<double>(run.tally.lost()) /
         static_cast<double>(std::max<std::uint64_t>(run.tally.expected, 1));
}

LineChart Chart(const Curve& curve, const std::string& title, const std::string& unit) {
  return {.title = title,
          .x = {.label = curve.axis, .logarithmic = false, .ticks = {}},
          .y = {.label = unit, .logarithmic = false, .ticks = {}},
          .series = {}};
}

template <class Value>
LineChart::Series Series(const Curve& curve, const std::string& name, const Value& value) {
  LineChart::Series series{name, {}};
  for (const Curve::Point& point : curve.points)
    series.points.emplace_back(point.x, value(point.run));
  return series;
}

}  // namespace

Curve GrowSubjects(const LoadSetup& setting) {
  Curve curve{"load-subjects", "Subjects at 60 Hz", "subjects", {}};
  for (const int subjects : {1, 50, 100, 200, 400, 700, 1000, 1400}) {
    Add(curve, subjects,
        ValueOrExit(
            RunFresh(setting, setting.recording, setting.rig, At60Hz(subjects, setting.seconds))));
  }
  return curve;
}

Curve GrowSubscribers(const LoadSetup& setting) {
  constexpr int kFew = 16;  // subjects: 64 subscribers of each receive 61,440 messages per second
  Curve curve{"load-subscribers",
              "Subscribers of each of 16 subjects at 60 Hz",
              "subscribers of each subject",
              {}};
  for (const int subscribers : {1, 2, 4, 8, 16, 32, 64}) {
    load::RunOptions options = At60Hz(kFew, setting.seconds);
    options.watchers = subscribers;
    Add(curve, subscribers,
        ValueOrExit(RunFresh(setting, setting.recording, setting.rig, options)));
  }
  return curve;
}

Curve GrowJoints(const LoadSetup& setting) {
  Curve curve{"load-joints", "Joints of each of 100 subjects at 60 Hz", "joints", {}};
  for (const int joints : {51, 100, 163, 250, 400}) {
    const auto recording = setting.folder / ("joints-" + std::to_string(joints) + ".bvh");
    if (Status status = SavePaddedRecording(setting.recording, joints, recording); !status.ok())
      FailWith(status);
    Add(curve, joints,
        ValueOrExit(RunFresh(setting, recording, setting.rig, At60Hz(kCrowd, setting.seconds))));
  }
  return curve;
}

Curve GrowRegions(const LoadSetup& setting) {
  Curve curve{"load-regions",
              "Regions and their drivers, 100 subjects at 60 Hz",
              "wrinkle weights of a subject",
              {}};
  for (const int copies : {1, 2, 3, 4}) {
    const auto rig = setting.folder / ("regions-" + std::to_string(copies) + ".json");
    if (Status status = SaveMultipliedRig(setting.rig, copies, rig); !status.ok()) FailWith(status);
    const auto weights = ValueOrExit(CountWeights(setting.recording, rig));
    Add(curve, weights,
        ValueOrExit(RunFresh(setting, setting.recording, rig, At60Hz(kCrowd, setting.seconds))));
  }
  return curve;
}

std::string Draw(const Curve& curve) {
  LineChart cpu = Chart(curve, curve.title + ": processor time", "% of a core");
  cpu.series = {Series(curve, "daemon", CorePercent)};
  LineChart latency = Chart(curve, "Latency", "ms");
  latency.series = {
      Series(curve, "p50", [](const load::RunResult& run) { return run.p(50.0) * 1e-3; }),
      Series(curve, "p99", [](const load::RunResult& run) { return run.p(99.0) * 1e-3; })};
  LineChart memory = Chart(curve, "Memory", "MiB resident");
  memory.series = {Series(curve, "daemon", Mebibytes)};
  return report::ToSvg({cpu, latency, memory});
}

std::string ToMarkdown(const Curve& curve) {
  report::Table table{curve.title,
                      {curve.axis, "poses/s", "CPU, % of a core", "us a pose", "p50 ms", "p99 ms",
                       "lost %", "wrong", "MiB"},
                      {}};
  for (const auto& [x, run] : curve.points) {
    table.rows.push_back({Fixed(x, 0), Fixed(run.planned_rate, 0), Fixed(CorePercent(run), 1),
                          Fixed(run.cpu_us_per_pose().value_or(0.0), 2),
                          Fixed(run.p(50.0) * 1e-3, 3), Fixed(run.p(99.0) * 1e-3, 3),
                          Fixed(LostPercent(run), 3), std::to_string(run.tally.wrong),
                          Fixed(Mebibytes(run), 1)});
  }
  return report::ToMarkdown(table);
}

nlohmann::json ToJson(const Curve& curve) {
  nlohmann::json points = nlohmann::json::array();
  for (const auto& [x, run] : curve.points)
    points.push_back({{"x", x}, {"run", load::ToJson(run)}});
  return {{"id", curve.id}, {"title", curve.title}, {"axis", curve.axis}, {"points", points}};
}

}  // namespace furrow::bench
