// SPDX-License-Identifier: Apache-2.0
// What a daemon on one core can take, and how its cost grows: the figures of docs/PERFORMANCE.md
// and the curves of docs/CAPACITY.md, by one command.
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
#include "bench/load/budget.h"
#include "bench/load/curves.h"
#include "bench/load/figures.h"
#include "bench/load/threads.h"
#include "bench/report/command_line.h"
#include "bench/report/machine.h"
#include "bench/report/results.h"
#include "bench/report/take.h"
#include "client/net/clock.h"
#include "report/table.h"
#include "report/words.h"

namespace furrow::bench {
namespace {

namespace fs = std::filesystem;

struct Options {
  Setting setting;
  std::string only;
};

fs::path DataFile(const std::string& name) { return Take(furrow::FindDataFile(name)); }

// One part of the measurement: its tables and figures; curves also draw themselves.
struct Part {
  std::string markdown;
  nlohmann::json json;
};
using Measure = std::function<Part(const Setting&)>;

Part Aims(const Setting& setting) {
  const auto aims = MeasureAims(setting);
  return {ToMarkdown(aims, "raw against raw"), ToJson(aims)};
}

Part Threads(const Setting& setting) {
  const auto threads = MeasureThreads(setting);
  return {ToMarkdown(threads), ToJson(threads)};
}

Part Drawn(const Curve& curve, const Setting& setting) {
  WriteResult(setting.out / (curve.id + ".svg"), Draw(curve));
  return {ToMarkdown(curve), ToJson(curve)};
}

Part Subjects(const Setting& setting) {
  const Curve curve = GrowSubjects(setting);
  Part part = Drawn(curve, setting);
  part.markdown += "\n" + BudgetMarkdown(curve, setting);
  return part;
}

const std::vector<std::pair<std::string, Measure>>& Parts() {
  static const std::vector<std::pair<std::string, Measure>> parts = {
      {"aims", Aims},
      {"threads", Threads},
      {"subjects", Subjects},
      {"subscribers", [](const Setting& s) { return Drawn(GrowSubscribers(s), s); }},
      {"joints", [](const Setting& s) { return Drawn(GrowJoints(s), s); }},
      {"regions", [](const Setting& s) { return Drawn(GrowRegions(s), s); }}};
  return parts;
}

std::vector<std::string> PartNames() {
  std::vector<std::string> names;
  for (const auto& [name, measure] : Parts()) names.push_back(name);
  return names;
}

std::string Heading(const Machine& machine, const Setting& setting, double minutes) {
  return "Measured by `bench_load`: " + ToText(machine) + ", load " +
         report::Fixed(machine.load, 1) + " before it began. Runs of " +
         report::Fixed(setting.seconds, 1) + " s, " +
         report::Counted(static_cast<std::uint64_t>(setting.rounds), "round") +
         " where runs are paired; it took " + report::Fixed(minutes, 1) + " minutes.\n\n";
}

int Run(Options options) {
  Setting& setting = options.setting;
  if (setting.recording.empty()) setting.recording = DataFile("recordings/performance.bvh");
  if (setting.rig.empty()) setting.rig = DataFile("default.rig.json");
  // It stays where the program fails: messages point to the daemon's log in it.
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
      "What a furrowd on one core can take, beside raw UDP echoes, and how its cost grows"};
  app.add_option("--out", options.setting.out,
                 "folder for load.md, load.json and the curves (SVG); with --only it is "
                 "load-PART.md and load-PART.json, and load.md stays as it is")
      ->capture_default_str();
  app.add_option("--only", options.only, "this part alone; default: all, a quarter of an hour")
      ->check(CLI::IsMember(furrow::bench::PartNames()));
  app.add_option("--daemon", options.setting.daemon, "furrowd; default: beside this program");
  app.add_option("--recording", options.setting.recording, "BVH; default: performance.bvh");
  app.add_option("--rig", options.setting.rig, "wrinkle rig; default: the default character's");
  app.add_option("--seconds", options.setting.seconds, "of one run")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  app.add_option("--rounds", options.setting.rounds, "of paired runs")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  furrow::bench::ReadCommandLine(app, argc, argv);
  furrow::bench::MakeResultFolder(options.setting.out);
  return furrow::bench::Run(options);
}
