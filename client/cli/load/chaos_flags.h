// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "client/chaos/link.h"

namespace furrow::cli {

// The direction in which faults are injected: to the daemon (up), from it (down), or both.
enum class ChaosWay { kUp, kDown, kBoth };

// The parsed fault options of `load` and `chaos`.
struct ChaosFlags {
  chaos::Faults options;
  std::vector<std::string> black_holes;  // validated arguments of chaos::ParseBlackHole()
  ChaosWay way = ChaosWay::kBoth;
};

// Adds the fault options to `command`. `flags` must outlive parsing.
void AddChaosFlags(CLI::App& command, ChaosFlags& flags);

// Sets `up` and `down` to the faults of each direction: those of `flags`, or none if `flags.way`
// excludes the direction.
void ReadChaosFlags(const ChaosFlags& flags, chaos::Faults* up, chaos::Faults* down);

}  // namespace furrow::cli
