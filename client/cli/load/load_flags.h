// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>

#include "client/cli/common/endpoint.h"
#include "client/cli/load/chaos_flags.h"
#include "client/cli/load/load_input.h"
#include "client/load/compare/comparison.h"
#include "client/load/run/run.h"

namespace furrow::cli {

// The parsed options of `furrow load`.
struct LoadFlags {
  std::string host;
  SecurityFlags security;
  LoadInput input;
  load::RunOptions run;
  int subjects = 0;  // 0: 1, or 256 with --find-max
  bool udp = false;  // the default, so the value is not read
  bool tcp = false;
  bool both = false;
  bool quantise = false;
  bool floats = false;
  std::uint16_t other_port = 0;    // port of the transport that `host` does not name; 0: default
  double late_ms = 1000.0 / 60.0;  // latency limit: one frame at 60 Hz
  int pid = 0;                     // process of the daemon; 0: find it by its port
  bool find_max = false;
  bool baseline = false;
  bool strict = false;
  load::ComparisonOptions comparison;  // its `run` is not used
  double round_seconds = 3.0;
  double time_limit_minutes = 7.0;
  ChaosFlags chaos;
  std::string json;  // files to write; empty: none
  std::string hgrm;
  std::string plot;
};

// Adds the options to `command`. `flags` must outlive parsing.
void AddLoadFlags(CLI::App& command, LoadFlags& flags);

// How the poses are packed: as the options say, or by default to fit datagrams over UDP.
[[nodiscard]] Packing PackingOf(const LoadFlags& flags);

// An error message about options that are valid alone and contradict each other; empty if there is
// none.
[[nodiscard]] std::string FindConflict(const LoadFlags& flags);

}  // namespace furrow::cli
