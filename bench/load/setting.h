// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "bench/load/daemon_process.h"
#include "client/load/run/run.h"

namespace furrow::bench {

// What all experiments are told.
struct Setting {
  std::filesystem::path daemon;     // furrowd
  std::filesystem::path recording;  // BVH
  std::filesystem::path rig;
  std::filesystem::path folder;  // for what is made meanwhile: rigs, recordings, the daemon's log
  std::filesystem::path out;     // for results
  double seconds = 2.0;          // of one run
  int rounds = 11;               // of paired runs
};

// Hooks of a run that nobody watches.
[[nodiscard]] load::RunHooks Silently();

// A new daemon with this rig, one run of this recording, packed. Errors: the daemon's and Run()'s.
[[nodiscard]] Result<load::RunResult> RunFresh(const Setting& setting,
                                               const std::filesystem::path& recording,
                                               const std::filesystem::path& rig,
                                               const load::RunOptions& options);

// So many subjects at 60 Hz.
[[nodiscard]] load::RunOptions At60Hz(int subjects, double seconds);

}  // namespace furrow::bench
