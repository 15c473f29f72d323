// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

#include "server/core/time.h"

namespace furrow::server {

// Returns the current time of the daemon's steady clock. Only the network layer and background
// threads call it, once per batch of packets; all other code receives the time as `now`.
[[nodiscard]] inline Time ReadClock() {
  return std::chrono::duration_cast<Time>(std::chrono::steady_clock::now().time_since_epoch());
}

// Returns the time of the system clock since 1970. It jumps when somebody sets the clock.
[[nodiscard]] inline Time ReadUnixClock() {
  return std::chrono::duration_cast<Time>(std::chrono::system_clock::now().time_since_epoch());
}

// The same in seconds, which the expiry of tokens counts in.
[[nodiscard]] inline std::uint64_t UnixSeconds() {
  return static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::seconds>(ReadUnixClock()).count());
}

}  // namespace furrow::server
