// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "bench/load/daemon_process.h"
#include "client/load/run/run.h"

namespace furrow::bench {

// The parameters that all experiments share.
struct LoadSetup {
  std::filesystem::path daemon;     // furrowd
  std::filesystem::path recording;  // BVH
  std::filesystem::path rig;
  std::filesystem::path folder;  // for intermediate files: rigs, recordings, the daemon's log
  std::filesystem::path out;     // for results
  double seconds = 2.0;          // duration of one run
  int rounds = 11;               // number of paired runs
};

// Run hooks that print nothing.
[[nodiscard]] load::RunHooks Silently();

// Starts a new daemon with `rig` and runs `recording` once, packed. Errors: those of the daemon and
// of Run().
[[nodiscard]] Result<load::RunResult> RunFresh(const LoadSetup& setting,
                                               const std::filesystem::path& recording,
                                               const std::filesystem::path& rig,
                                               const load::RunOptions& options);

// Options of a run with `subjects` subjects at 60 Hz.
[[nodiscard]] load::RunOptions At60Hz(int subjects, double seconds);

}  // namespace furrow::bench
