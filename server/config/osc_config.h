// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/status.h"
#include "server/core/network_address.h"

namespace furrow::server {

// Weights to one UDP address, as OSC ([[osc.target]], and the body of POST /api/osc).
struct OscTargetConfig {
  HostPort to;
  std::string profile = "furrow";  // name of a shipped profile, or a file
  std::string prefix = "furrow";   // first part of the addresses, for profiles that use it
  std::string subject;             // empty: all subjects
  std::string pattern = "*";       // names of the weights, as comma-separated globs
  double rate_hz = 0;              // most frames per second and subject, [0, 1000]; 0: every pose
  friend bool operator==(const OscTargetConfig&, const OscTargetConfig&) = default;
};

// Checks everything but the address and the profile. Errors: kInvalidArgument, with the name of the
// field as `where`.
[[nodiscard]] Status CheckOscTarget(const OscTargetConfig& target);

struct OscConfig {
  std::vector<OscTargetConfig> targets;
  // Numeric addresses that HTTP clients may add as targets, besides those of this machine.
  std::vector<std::string> allow;
  friend bool operator==(const OscConfig&, const OscConfig&) = default;
};

}  // namespace furrow::server
