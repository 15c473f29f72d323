// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "client/load/chaos_link.h"
#include "client/load/chaos_stream.h"

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

// "up: 1000 datagrams, lost 3, ..." of what was done, and where there were TCP connections a second
// line "up over TCP: 2 connections, 5000 bytes, ...". Ends without a line break.
[[nodiscard]] std::string Describe(const std::string& way, const load::ChaosCounts& counts,
                                   const load::ChaosStreamCounts& stream_counts);

}  // namespace furrow::cli
