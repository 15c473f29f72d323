// SPDX-License-Identifier: Apache-2.0
#include "bench/load/threads.h"

#include <nlohmann/json.hpp>

#include "bench/load/paired_runs.h"
#include "bench/report/value_or_exit.h"
#include "client/load/report/comparison_report.h"
#include "report/table.h"

namespace furrow::bench {
namespace {

constexpr double kRate = 50000.0;

DaemonProcess Daemon(const LoadSetup& setting, int threads) {
  return ValueOrExit(
      DaemonProcess::Start(setting.daemon, setting.rig, setting.folder, {.threads = threads}));
}

// 2 and 4, and on larger machines 8 and so on: the generator keeps at least half of the cores.
std::vector<int> ThreadCounts() {
  std::vector<int> counts = {2, 4};
  while (counts.back() * 4 <= NumCores()) counts.push_back(counts.back() * 2);
  return counts;
}

std::vector<std::string> Row(int threads, const load::Figure& figure, const std::string& what) {
  const int digits = figure.unit == "us" ? 1 : 0;
  return {std::to_string(threads), what, report::Fixed(figure.raw, digits) + " " + figure.unit,
          Between(figure.ratio) + "x", Between(figure.control) + "x"};
}

void AddRow(const ThreadsResult& result, const load::Comparison& comparison,
            const std::string& name, const std::string& what, report::Table* table) {
  const load::Figure* figure = FindFigure(comparison, name);
  if (figure != nullptr) table->rows.push_back(Row(result.threads, *figure, what));
}

}  // namespace

std::vector<ThreadsResult> MeasureThreads(const LoadSetup& setting) {
  std::vector<ThreadsResult> results;
  const DaemonProcess one = Daemon(setting, 1);
  const DaemonProcess control = Daemon(setting, 1);
  for (const int threads : ThreadCounts()) {
    const DaemonProcess several = Daemon(setting, threads);
    PairedRuns duel(
        setting, {.server = several.target(), .raw = one.target(), .control = control.target()}, 1);
    ThreadsResult& result = results.emplace_back();
    result.threads = threads;
    result.steady = duel.At(kRate);
    result.highest = duel.Highest();
  }
  return results;
}

std::string ToMarkdown(const std::vector<ThreadsResult>& results) {
  report::Table table{
      "Daemon threads compared with one thread",
      {"threads", "figure", "one thread", "of one thread (middle half)", "one thread again"},
      {}};
  for (const ThreadsResult& result : results) {
    AddRow(result, result.steady, "CPU a pose", "processor time per pose at 50,000 poses/s",
           &table);
    AddRow(result, result.steady, "p50", "round trip at 50,000 poses/s, p50", &table);
    AddRow(result, result.highest, "highest rate",
           result.highest.generator_behind_at ? "highest rate without loss (the generator's limit)"
                                              : "highest rate without loss",
           &table);
  }
  return report::ToMarkdown(table);
}

nlohmann::json ToJson(const std::vector<ThreadsResult>& results) {
  nlohmann::json json = nlohmann::json::array();
  for (const ThreadsResult& result : results) {
    json.push_back({{"threads", result.threads},
                    {"steady", load::ToJson(result.steady)},
                    {"highest", load::ToJson(result.highest)}});
  }
  return json;
}

}  // namespace furrow::bench
