// SPDX-License-Identifier: Apache-2.0
// Measures the capacity of a daemon on one core and how its cost grows. Writes the figures of
// docs/PERFORMANCE.md and the curves of docs/CAPACITY.md.
#include <cstdio>
#include <filesystem>
#include <functional>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "base/data_dir.h"
#include "base/text.h"
#include "bench/load/budget.h"
#include "bench/load/cold.h"
#include "bench/load/curves.h"
#include "bench/load/measure_aims.h"
#include "bench/load/threads.h"
#include "bench/report/command_line.h"
#include "bench/report/machine.h"
#include "bench/report/results.h"
#include "bench/report/value_or_exit.h"
#include "client/net/clock.h"
#include "report/table.h"

namespace furrow::bench {
namespace {

namespace fs = std::filesystem;

struct Options {
  LoadSetup setting;
  std::string only;
};

fs::path DataFile(const std::string& name) { return ValueOrExit(furrow::FindDataFile(name)); }

// The tables and figures of one part of the measurement. Curves also write an SVG picture.
struct Part {
  std::string markdown;
  nlohmann::json json;
};
using Measure = std::function<Part(const LoadSetup&)>;

Part Aims(const LoadSetup& setting) {
  const auto aims = MeasureAims(setting);
  return {ToMarkdown(aims, "raw against raw"), ToJson(aims)};
}

Part Cold(const LoadSetup& setting) {
  const auto rows = MeasureCold(setting);
  return {ToMarkdown(rows), ToJson(rows)};
}

Part Threads(const LoadSetup& setting) {
  const auto threads = MeasureThreads(setting);
  return {ToMarkdown(threads), ToJson(threads)};
}

Part Drawn(const Curve& curve, const LoadSetup& setting) {
  WriteResult(setting.out / (curve.id + ".svg"), Draw(curve));
  return {ToMarkdown(curve), ToJson(curve)};
}

Part Subjects(const LoadSetup& setting) {
  const Curve curve = GrowSubjects(setting);
  Part part = Drawn(curve, setting);
  part.markdown += "\n" + BudgetMarkdown(curve, setting);
  return part;
}

const std::vector<std::pair<std::string, Measure>>& Parts() {
  static const std::vector<std::pair<std::string, Measure>> parts = {
      {"cold", Cold},
      {"aims", Aims},
      {"threads", Threads},
      {"subjects", Subjects},
      {"subscribers", [](const LoadSetup& s) { return Drawn(GrowSubscribers(s), s); }},
      {"joints", [](const LoadSetup& s) { return Drawn(GrowJoints(s), s); }},
      {"regions", [](const LoadSetup& s) { return Drawn(GrowRegions(s), s); }}};
  return parts;
}

std::vector<std::string> PartNames() {
  std::vector<std::string> names;
  for (const auto& [name, measure] : Parts()) names.push_back(name);
  return names;
}

std::string Heading(const Machine& machine, const LoadSetup& setting, double minutes) {
  return "Measured by `bench_load`: " + ToText(machine) + ", load " +
         report::Fixed(machine.load, 1) + " before it began. Runs of " +
         report::Fixed(setting.seconds, 1) + " s, " +
         Counted(static_cast<std::uint64_t>(setting.rounds), "round") +
         " where runs are paired; it took " + report::Fixed(minutes, 1) + " minutes.\n\n";
}

int Run(Options options) {
  LoadSetup& setting = options.setting;
  if (setting.recording.empty()) setting.recording = DataFile("recordings/performance.bvh");
  if (setting.rig.empty()) setting.rig = DataFile("default.rig.json");
  // Kept if the program fails, because messages refer to the daemon's log in it.
  setting.folder = fs::temp_directory_path() / ("bench_load-" + std::to_string(getpid()));
  MakeResultFolder(setting.folder);
  const Machine machine = ThisMachine();
  const std::int64_t begin_ns = net::SteadyNanoseconds();
  std::string markdown;
  nlohmann::json json = {{"measured", ToJson(machine)},
                         {"seconds_of_a_run", setting.seconds},
                         {"rounds", setting.rounds}};
  for (const auto& [name, measure] : Parts()) {
    if (!options.only.empty() && options.only != name) continue;
    const Part part = measure(setting);
    std::printf("%s\n", part.markdown.c_str());
    std::fflush(stdout);
    markdown += part.markdown + "\n";
    json[name] = part.json;
  }
  const double minutes = static_cast<double>(net::SteadyNanoseconds() - begin_ns) / 60e9;
  json["minutes"] = minutes;
  const std::string stem = options.only.empty() ? "load" : "load-" + options.only;
  WriteResult(setting.out / (stem + ".md"), Heading(machine, setting, minutes) + markdown);
  WriteResult(setting.out / (stem + ".json"), json.dump(2) + "\n");
  std::error_code ignored;
  fs::remove_all(setting.folder, ignored);
  return 0;
}

}  // namespace
}  // namespace furrow::bench

int main(int argc, char** argv) {
  furrow::bench::Options options;
  options.setting.daemon = std::filesystem::path(argv[0]).parent_path() / "furrowd";
  options.setting.out = "bench-out";
  CLI::App app{
      "Measure the capacity of furrowd on one core, compared with raw UDP echo servers, and its "
      "cost"};
  app.add_option(
         "--out", options.setting.out,
         "Folder for load.md, load.json and the curves (SVG). --only writes load-PART.md and "
         "load-PART.json and keeps load.md")
      ->capture_default_str();
  app.add_option("--only", options.only,
                 "Measure only this part (default: all parts, about 25 minutes)")
      ->check(CLI::IsMember(furrow::bench::PartNames()));
  app.add_option("--daemon", options.setting.daemon,
                 "Path of furrowd (default: beside this program)");
  app.add_option("--recording", options.setting.recording, "BVH file (default: performance.bvh)");
  app.add_option("--rig", options.setting.rig,
                 "Wrinkle rig (default: that of the default character)");
  app.add_option("--seconds", options.setting.seconds, "Seconds per run")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  app.add_option("--rounds", options.setting.rounds, "Number of paired runs")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  furrow::bench::ReadCommandLine(app, argc, argv);
  furrow::bench::MakeResultFolder(options.setting.out);
  return furrow::bench::Run(options);
}
