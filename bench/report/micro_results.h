// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "base/status.h"

namespace furrow::bench {

// What a program of Google Benchmark measured (--benchmark_out=FILE): nanoseconds of processor time
// an iteration and the other counters, each the median over the repetitions.
class MicroResults {
 public:
  // Errors: kIo; kInvalidArgument where it is not such a file, or where a benchmark in it failed.
  [[nodiscard]] static Result<MicroResults> Load(const std::filesystem::path& path);
  [[nodiscard]] static Result<MicroResults> Parse(const std::string& text,
                                                  const std::string& where);

  // Of a benchmark by its whole name ("BM_CopyPose/joints:51/packed:0"). Errors: kNotFound where it
  // was not measured.
  [[nodiscard]] Result<double> Nanoseconds(const std::string& name) const;
  [[nodiscard]] Result<double> Counter(const std::string& name, const std::string& counter) const;

  // By name: nanoseconds and counters.
  [[nodiscard]] nlohmann::json ToJson() const;

 private:
  using Medians = std::map<std::string, double>;  // by counter

  std::map<std::string, Medians> benchmarks_;
};

}  // namespace furrow::bench
