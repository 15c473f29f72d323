// SPDX-License-Identifier: Apache-2.0
// What a daemon on one core can take, and how its cost grows: the figures of docs/PERFORMANCE.md
// and the curves of docs/CAPACITY.md, by one command.
#include <cstdio>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "bench/load/budget.h"
#include "bench/load/curves.h"
#include "bench/load/figures.h"
#include "bench/report/results.h"
#include "bench/report/take.h"
#include "character/data_dir.h"

namespace furrow::bench {
namespace {

struct Options {
  Setting setting;
  std::filesystem::path out;
  std::string only;
};

std::filesystem::path DataFile(const std::string& name) {
  return Take(character::FindDataFile(name));
}

// Prints a part as it is done.
void Say(const std::string& markdown, std::string* all) {
  std::printf("%s\n", markdown.c_str());
  std::fflush(stdout);
  *all += markdown + "\n";
}

int Run(Options options) {
  Setting& setting = options.setting;
  if (setting.recording.empty()) setting.recording = DataFile("recordings/performance.bvh");
  if (setting.rig.empty()) setting.rig = DataFile("default.rig.json");
  setting.folder = options.out;
  std::string markdown;
  nlohmann::json json;
  const auto wanted = [&](const std::string& id) {
    return options.only.empty() || options.only == id;
  };
  if (wanted("aims")) {
    const auto aims = MeasureAims(setting);
    Say(ToMarkdown(aims, "raw against raw"), &markdown);
    json["aims"] = ToJson(aims);
  }
  if (wanted("threads")) {
    const auto threads = MeasureThreads(setting);
    Say(ToMarkdown(threads, "raw against raw", "Threads of the daemon"), &markdown);
    json["threads"] = ToJson(threads);
  }
  const std::pair<const char*, Curve (*)(const Setting&)> curves[] = {
      {"subjects", GrowSubjects},
      {"subscribers", GrowSubscribers},
      {"joints", GrowJoints},
      {"regions", GrowRegions}};
  for (const auto& [id, grow] : curves) {
    if (!wanted(id)) continue;
    const Curve curve = grow(setting);
    Say(ToMarkdown(curve), &markdown);
    WriteResult(options.out / (curve.id + ".svg"), Draw(curve));
    if (std::string(id) == "subjects") Say(BudgetMarkdown(curve, setting), &markdown);
    json["curves"].push_back(ToJson(curve));
  }
  WriteResult(options.out / "load.md", markdown);
  WriteResult(options.out / "load.json", json.dump(2) + "\n");
  return 0;
}

}  // namespace
}  // namespace furrow::bench

int main(int argc, char** argv) {
  furrow::bench::Options options;
  options.setting.daemon = std::filesystem::path(argv[0]).parent_path() / "furrowd";
  options.out = "bench-out";
  CLI::App app{
      "What a furrowd on one core can take, beside raw UDP echoes, and how its cost grows"};
  app.add_option("--out", options.out, "folder for load.md, load.json and the curves (SVG)")
      ->capture_default_str();
  app.add_option("--only", options.only,
                 "one of aims, threads, subjects, subscribers, joints, regions");
  app.add_option("--daemon", options.setting.daemon, "furrowd; default: beside this program");
  app.add_option("--recording", options.setting.recording, "BVH; default: performance.bvh");
  app.add_option("--rig", options.setting.rig, "wrinkle rig; default: the default character's");
  app.add_option("--seconds", options.setting.seconds, "of one run")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  app.add_option("--rounds", options.setting.rounds, "of paired runs")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  furrow::bench::MakeResultFolder(options.out);
  return furrow::bench::Run(options);
}
