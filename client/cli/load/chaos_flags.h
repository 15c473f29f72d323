// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "client/chaos/link.h"

namespace furrow::cli {

// Which way packets are mistreated.
enum class ChaosWay { kUp, kDown, kBoth };

// What `load` and `chaos` can be told to do to packets.
struct ChaosFlags {
  load::ChaosOptions options;
  std::vector<std::string> black_holes;  // as ParseBlackHole(), checked when parsed
  ChaosWay way = ChaosWay::kBoth;
};

void AddChaosFlags(CLI::App& command, ChaosFlags& flags);

// The options of either way, black holes parsed.
void ReadChaosFlags(const ChaosFlags& flags, load::ChaosOptions* up, load::ChaosOptions* down);

}  // namespace furrow::cli
