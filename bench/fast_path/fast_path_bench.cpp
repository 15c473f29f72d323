// SPDX-License-Identifier: Apache-2.0
// Writes one page and one JSON file with the results of the fast path: solver, codec, sending to
// subscribers, and the daemon end to end. bench/run.sh runs all of them.
#include <fstream>
#include <sstream>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "bench/fast_path/tables.h"
#include "bench/report/aims.h"
#include "bench/report/command_line.h"
#include "bench/report/machine.h"
#include "bench/report/results.h"
#include "bench/report/value_or_exit.h"

namespace furrow::bench {
namespace {

struct Options {
  std::filesystem::path from;
  std::filesystem::path out = "bench-out";
};

nlohmann::json ReadJson(const std::filesystem::path& path) {
  std::ifstream file(path);
  auto json = nlohmann::json::parse(file, nullptr, false);
  if (json.is_discarded())
    FailWith({StatusCode::kInvalidArgument, "the file is not JSON", path.string()});
  return json;
}

std::string ReadText(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) FailWith({StatusCode::kIo, "cannot read the file", path.string()});
  return text.str();
}

int Run(const Options& options) {
  const auto solver = ValueOrExit(MicroResults::Load(options.from / "wrinkle.json"));
  const auto codec = ValueOrExit(MicroResults::Load(options.from / "codec.json"));
  const nlohmann::json load = ReadJson(options.out / "load.json");
  const auto aims = ValueOrExit(AimsFromJson(load.value("aims", nlohmann::json())));
  const Machine machine = ThisMachine();
  WriteResult(options.out / "fast_path.md",
              "# The fast path\n\nMeasured by `bench/run.sh`, which ended on " + ToText(machine) +
                  ". Method: [PERFORMANCE.md](../PERFORMANCE.md).\n\n" + SolverTables(solver) +
                  "\n" + CodecTables(codec) + "\n" + ReadText(options.from / "fanout.md") +
                  ToMarkdown(aims, "raw against raw", "End to end") +
                  "\nBy threads, subjects, subscribers, joints and regions: [load.md](load.md).\n");
  const nlohmann::json json = {{"measured", ToJson(machine)},
                               {"solver", solver.ToJson()},
                               {"codec", codec.ToJson()},
                               {"fanout", ReadJson(options.from / "fanout.json")},
                               {"end_to_end", load["aims"]}};
  WriteResult(options.out / "fast_path.json", json.dump(2) + "\n");
  return 0;
}

}  // namespace
}  // namespace furrow::bench

int main(int argc, char** argv) {
  furrow::bench::Options options;
  CLI::App app{"Write one page with the results of the fast-path benchmarks (see bench/run.sh)"};
  app.add_option("--from", options.from,
                 "Folder of wrinkle.json and codec.json (--benchmark_out) and of bench_fanout's "
                 "fanout.md and fanout.json")
      ->required();
  app.add_option("--out", options.out,
                 "Folder of bench_load's load.json, for fast_path.md and fast_path.json")
      ->capture_default_str();
  furrow::bench::ReadCommandLine(app, argc, argv);
  return furrow::bench::Run(options);
}
