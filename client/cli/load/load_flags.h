// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>

#include "client/cli/load/chaos_flags.h"
#include "client/cli/load/load_input.h"
#include "client/load/compare/comparison.h"
#include "client/load/run.h"

namespace furrow::cli {

// What `load` was told.
struct LoadFlags {
  std::string host;
  LoadInput input;
  load::RunOptions run;
  int subjects = 0;  // 0: 1, or 256 for --find-max
  bool udp = false;  // the default: said for clarity
  bool tcp = false;
  bool both = false;
  std::uint16_t other_port = 0;
  double late_ms = 1000.0 / 60.0;
  int pid = 0;
  bool find_max = false;
  bool baseline = false;
  bool strict = false;
  load::ComparisonOptions comparison;  // without what is in `run`
  double round_seconds = 3.0;
  double time_limit_minutes = 7.0;
  ChaosFlags chaos;
  std::string json;
  std::string hgrm;
  std::string plot;
};

void AddLoadFlags(CLI::App& command, LoadFlags& flags);

// What is wrong with options that are each right, and what to do; empty: nothing.
[[nodiscard]] std::string WrongUsage(const LoadFlags& flags);

}  // namespace furrow::cli
