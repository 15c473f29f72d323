// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "client/chaos/link.h"
#include "client/chaos/stream.h"

namespace furrow::load {

// What a proxy was asked to do in one direction, and what it did.
struct ChaosOutcome {
  ChaosOptions options;
  ChaosCounts counts;
  ChaosStreamCounts stream_counts;
};

// "up: 1000 datagrams, lost 3, ..." with all that was asked for, also where it befell none, and
// where there were TCP connections a second line "up over TCP: 2 connections, 5000 bytes, ...".
[[nodiscard]] std::string ToText(const std::string& way, const ChaosOutcome& outcome);

// A sentence about what was asked for and befell nothing, either way, with a line break; empty
// where there is no such thing. Jitter befalls all.
[[nodiscard]] std::string NothingPlanted(const ChaosOutcome& up, const ChaosOutcome& down);

// Those of `options` that only datagrams know, as the command line calls them: "--loss, --swap".
[[nodiscard]] std::string DatagramFaults(const ChaosOptions& options);

[[nodiscard]] nlohmann::json ToJson(const ChaosOptions& options);
// The counts alone.
[[nodiscard]] nlohmann::json ToJson(const ChaosOutcome& outcome);

}  // namespace furrow::load
