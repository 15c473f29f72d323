// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "base/status.h"

namespace furrow::bench {

// The results of a Google Benchmark program (--benchmark_out=FILE): processor time per iteration in
// nanoseconds, and counters. Each value is the median over the repetitions.
class MicroResults {
 public:
  // Errors: kIo; kInvalidArgument for another kind of file, or if a benchmark in it failed.
  [[nodiscard]] static Result<MicroResults> Load(const std::filesystem::path& path);
  [[nodiscard]] static Result<MicroResults> Parse(const std::string& text,
                                                  const std::string& where);

  // Values of a benchmark by its full name ("BM_CopyPose/joints:51/packed:0"). Errors: kNotFound.
  [[nodiscard]] Result<double> Nanoseconds(const std::string& name) const;
  [[nodiscard]] Result<double> Counter(const std::string& name, const std::string& counter) const;

  // Nanoseconds and counters, by name.
  [[nodiscard]] nlohmann::json ToJson() const;

 private:
  using Medians = std::map<std::string, double>;  // by name of the counter

  std::map<std::string, Medians> benchmarks_;
};

}  // namespace furrow::bench
