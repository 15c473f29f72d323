// SPDX-License-Identifier: Apache-2.0
#include "bench/report/micro_results.h"

#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "report/statistics.h"

namespace furrow::bench {
namespace {

constexpr const char* kNanoseconds = "cpu_ns";
using Samples = std::map<std::string, std::map<std::string, std::vector<double>>>;

// The numbers that Google Benchmark itself writes. All other numbers are counters of the benchmark.
bool IsOwn(const std::string& key) {
  return key == "family_index" || key == "per_family_instance_index" || key == "repetitions" ||
         key == "repetition_index" || key == "threads" || key == "iterations" ||
         key == "real_time" || key == "cpu_time";
}

double NanosecondsOf(const std::string& unit) {
  if (unit == "us") return 1e3;
  if (unit == "ms") return 1e6;
  return unit == "s" ? 1e9 : 1.0;
}

void AddRun(const nlohmann::json& run, Samples* samples) {
  auto& counters = (*samples)[run.at("run_name").get<std::string>()];
  counters[kNanoseconds].push_back(run.at("cpu_time").get<double>() *
                                   NanosecondsOf(run.value("time_unit", "ns")));
  for (const auto& [key, value] : run.items()) {
    if (value.is_number() && !IsOwn(key)) counters[key].push_back(value.get<double>());
  }
}

}  // namespace

Result<MicroResults> MicroResults::Load(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) return Status(StatusCode::kIo, "cannot read the file", path.string());
  return Parse(text.str(), path.string());
}

Result<MicroResults> MicroResults::Parse(const std::string& text, const std::string& where) {
  Samples samples;
  try {
    const nlohmann::json file = nlohmann::json::parse(text);
    for (const nlohmann::json& run : file.at("benchmarks")) {
      if (run.value("error_occurred", false)) {
        return Status(
            StatusCode::kInvalidArgument,
            run.value("name", "a benchmark") + " failed: " + run.value("error_message", ""), where);
      }
      if (run.value("run_type", "") == "iteration") AddRun(run, &samples);
    }
  } catch (const nlohmann::json::exception& error) {
    return Status(StatusCode::kInvalidArgument,
                  std::string("not a result of Google Benchmark: ") + error.what(), where);
  }
  MicroResults results;
  for (auto& [name, counters] : samples) {
    for (auto& [counter, values] : counters)
      results.benchmarks_[name][counter] = report::Median(std::move(values));
  }
  return results;
}

Result<double> MicroResults::Nanoseconds(const std::string& name) const {
  return Counter(name, kNanoseconds);
}

Result<double> MicroResults::Counter(const std::string& name, const std::string& counter) const {
  const auto benchmark = benchmarks_.find(name);
  if (benchmark != benchmarks_.end()) {
    const auto median = benchmark->second.find(counter);
    if (median != benchmark->second.end()) return median->second;
  }
  return Status(StatusCode::kNotFound, "no measurement of " + counter, name);
}

nlohmann::json MicroResults::ToJson() const { return benchmarks_; }

}  // namespace furrow::bench
