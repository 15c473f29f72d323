// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace furrow::server {

// The longest delay of a jitter buffer, milliseconds.
inline constexpr double kMaxJitterDelayMs = 1000.0;

// How long the poses of some subjects wait, so that they leave in order and evenly.
struct JitterRule {
  std::string subjects = "*";  // comma-separated globs (protocol/messages/pattern.h)
  double delay_ms = 0.0;       // [0, kMaxJitterDelayMs]; 0: no buffer
  friend bool operator==(const JitterRule&, const JitterRule&) = default;
};

}  // namespace furrow::server
