// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "base/status.h"

namespace furrow::server {

// The longest delay of a jitter buffer, milliseconds.
inline constexpr double kMaxJitterDelayMs = 1000.0;

// How long the poses of some subjects wait, so that they leave in order and evenly.
struct JitterRule {
  std::string subjects = "*";  // comma-separated globs (protocol/messages/pattern.h)
  double delay_ms = 0.0;       // [0, kMaxJitterDelayMs]; 0: no buffer
  friend bool operator==(const JitterRule&, const JitterRule&) = default;
};

// Parses "MS" (of all subjects) or "SUBJECTS=MS", where SUBJECTS is a comma-separated list of
// globs. Errors: kInvalidArgument.
[[nodiscard]] Result<JitterRule> ParseJitterRule(std::string_view text);

}  // namespace furrow::server
