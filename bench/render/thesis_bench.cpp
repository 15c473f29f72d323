// SPDX-License-Identifier: Apache-2.0
// Repeats tables 5.1 and 5.2 and figure 5.1 of the thesis with the same triangle counts, lights,
// resolution and depth maps. Compares the frame rate of every row, relative to its baseline, with
// the thesis.
#include <cstdio>
#include <filesystem>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "bench/render/experiments.h"
#include "bench/report/interleave.h"
#include "bench/report/results.h"
#include "report/bar_chart.h"
#include "report/statistics.h"
#include "report/table.h"

namespace furrow::bench {
namespace {

using report::BarChart;
using report::Fixed;
using report::Median;
using report::Table;

struct Options {
  ExperimentOptions experiment;
  int repetitions = 5;
  std::string only;
  std::filesystem::path out;
};

// The measurements of one row.
struct Outcome {
  std::vector<Sample> samples;           // seconds per frame, one per repetition
  std::vector<render::PassTime> passes;  // medians
  [[nodiscard]] double fps() const { return 1.0 / MedianWall(samples); }
};

std::vector<render::PassTime> MedianPasses(const Row& row, const Experiment& experiment,
                                           int repetitions) {
  std::vector<std::vector<render::PassTime>> frames;
  for (int i = 0; i < repetitions; ++i) {
    frames.push_back(experiment.scenes[row.scene]->TimePasses(row.settings));
  }
  std::vector<render::PassTime> medians = frames.front();
  for (std::size_t pass = 0; pass < medians.size(); ++pass) {
    std::vector<double> gpu;
    std::vector<double> wall;
    for (const auto& frame : frames) {
      gpu.push_back(frame.at(pass).gpu_ms);
      wall.push_back(frame.at(pass).wall_ms);
    }
    medians[pass].gpu_ms = Median(gpu);
    medians[pass].wall_ms = Median(wall);
  }
  return medians;
}

std::vector<Outcome> Measure(const Experiment& experiment, const Options& options) {
  std::vector<Sampler> samplers;
  for (const Row& row : experiment.rows) {
    samplers.push_back([&] {
      return experiment.scenes[row.scene]->SecondsPerFrame(row.settings, options.experiment.frames);
    });
  }
  const auto samples = Interleave(samplers, options.repetitions);
  std::vector<Outcome> outcomes;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    outcomes.push_back(
        {samples[i], MedianPasses(experiment.rows[i], experiment, options.repetitions)});
  }
  return outcomes;
}

std::string Percent(double share) { return Fixed(100.0 * share, 2) + "%"; }

// Processor time of the baseline divided by that of a row: the relative frame rate on an otherwise
// idle machine with a software renderer.
double CpuShare(const std::vector<Outcome>& outcomes, const Experiment& experiment,
                std::size_t row) {
  const std::size_t baseline = experiment.rows[row].baseline;
  return MedianCpu(outcomes[baseline].samples) / MedianCpu(outcomes[row].samples);
}

Table RowTable(const Experiment& experiment, const std::vector<Outcome>& outcomes) {
  Table table{experiment.title,
              {"run", "ms per frame", "frames/s", "of its baseline", "CPU ms per frame",
               "of its baseline, by CPU", "thesis: frames/s", "thesis: of its baseline"},
              {}};
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const Row& row = experiment.rows[i];
    table.rows.push_back(
        {row.name, Fixed(1e3 * MedianWall(outcomes[i].samples), 2), Fixed(outcomes[i].fps(), 2),
         Percent(outcomes[i].fps() / outcomes[row.baseline].fps()),
         Fixed(1e3 * MedianCpu(outcomes[i].samples), 2), Percent(CpuShare(outcomes, experiment, i)),
         row.thesis_fps > 0.0 ? Fixed(row.thesis_fps, 0) : "",
         row.thesis_share > 0.0 ? Percent(row.thesis_share) : ""});
  }
  return table;
}

Table PassTable(const Experiment& experiment, const std::vector<Outcome>& outcomes) {
  Table table{experiment.title + ": passes, each drawn alone",
              {"run", "pass", "GPU timer, ms", "wall, ms"},
              {}};
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    for (const render::PassTime& pass : outcomes[i].passes) {
      table.rows.push_back(
          {experiment.rows[i].name, pass.pass, Fixed(pass.gpu_ms, 3), Fixed(pass.wall_ms, 3)});
    }
  }
  return table;
}

nlohmann::json ToJson(const Experiment& experiment, const std::vector<Outcome>& outcomes) {
  nlohmann::json rows = nlohmann::json::array();
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const Row& row = experiment.rows[i];
    nlohmann::json wall = nlohmann::json::array();
    nlohmann::json cpu = nlohmann::json::array();
    for (const Sample& sample : outcomes[i].samples) {
      wall.push_back(sample.wall);
      cpu.push_back(sample.cpu);
    }
    nlohmann::json passes = nlohmann::json::array();
    for (const render::PassTime& pass : outcomes[i].passes) {
      passes.push_back({{"pass", pass.pass}, {"gpu_ms", pass.gpu_ms}, {"wall_ms", pass.wall_ms}});
    }
    rows.push_back({{"run", row.name},
                    {"seconds_per_frame", wall},
                    {"cpu_seconds_per_frame", cpu},
                    {"median_ms", 1e3 * MedianWall(outcomes[i].samples)},
                    {"median_cpu_ms", 1e3 * MedianCpu(outcomes[i].samples)},
                    {"frames_per_second", outcomes[i].fps()},
                    {"baseline", experiment.rows[row.baseline].name},
                    {"of_baseline", outcomes[i].fps() / outcomes[row.baseline].fps()},
                    {"of_baseline_by_cpu", CpuShare(outcomes, experiment, i)},
                    {"thesis_frames_per_second", row.thesis_fps},
                    {"thesis_of_baseline", row.thesis_share},
                    {"passes", passes}});
  }
  return {{"id", experiment.id}, {"title", experiment.title}, {"rows", rows}};
}

// Frame rates relative to the baseline, measured and in the thesis.
BarChart Chart(const Experiment& experiment, const std::vector<Outcome>& outcomes) {
  BarChart chart{experiment.title,
                 "frame rate, % of its baseline",
                 {"furrow, by CPU", "furrow, by the wall", "thesis"},
                 {}};
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const Row& row = experiment.rows[i];
    std::vector<double> values = {100.0 * CpuShare(outcomes, experiment, i),
                                  100.0 * outcomes[i].fps() / outcomes[row.baseline].fps()};
    if (row.thesis_share > 0.0) values.push_back(100.0 * row.thesis_share);
    chart.groups.push_back({row.name, values});
  }
  return chart;
}

int Run(const Options& options) {
  nlohmann::json report = {{"width", options.experiment.size.width},
                           {"height", options.experiment.size.height},
                           {"repetitions", options.repetitions},
                           {"frames_per_repetition", options.experiment.frames},
                           {"experiments", nlohmann::json::array()}};
  std::string markdown;
  for (const auto& make : {MakeTable51, MakeTable52, MakeFigure51, MakeMethods}) {
    const Experiment experiment = make(options.experiment);
    if (!options.only.empty() && options.only != experiment.id) continue;
    report["device"] = experiment.scenes.front()->device();
    const std::vector<Outcome> outcomes = Measure(experiment, options);
    const std::string text = ToMarkdown(RowTable(experiment, outcomes)) + "\n" +
                             ToMarkdown(PassTable(experiment, outcomes)) + "\n";
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
    markdown += text;
    report["experiments"].push_back(ToJson(experiment, outcomes));
    if (!options.out.empty()) {
      WriteResult(options.out / (experiment.id + ".svg"), ToSvg(Chart(experiment, outcomes)));
    }
  }
  std::printf("device: %s\n", report.value("device", "none measured").c_str());
  if (!options.out.empty()) {
    WriteResult(options.out / "thesis.json", report.dump(2) + "\n");
    WriteResult(options.out / "thesis.md", markdown);
  }
  return 0;
}

}  // namespace
}  // namespace furrow::bench

int main(int argc, char** argv) {
  furrow::bench::Options options;
  CLI::App app{"Repeat tables 5.1 and 5.2 and figure 5.1 of the thesis"};
  app.add_option("--out", options.out, "Folder for thesis.json, thesis.md and the charts (SVG)");
  app.add_option("--only", options.only, "One of table-5.1, table-5.2, figure-5.1, methods");
  app.add_option("--repetitions", options.repetitions, "Samples per row, taken in turn")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--frames", options.experiment.frames, "Frames per sample")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--width", options.experiment.size.width, "Size in pixels")->capture_default_str();
  app.add_option("--height", options.experiment.size.height, "Size in pixels")
      ->capture_default_str();
  app.add_option("--device", options.experiment.device, "EGL device (as for furrow render)");
  CLI11_PARSE(app, argc, argv);
  if (!options.out.empty()) furrow::bench::MakeResultFolder(options.out);
  return furrow::bench::Run(options);
}
