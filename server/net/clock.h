// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "server/core/time.h"

namespace furrow::server {

// Returns the current time of the daemon's steady clock. Only the network layer and background
// threads call it, once per batch of packets; all other code receives the time as `now`.
[[nodiscard]] inline Time ReadClock() {
  return std::chrono::duration_cast<Time>(std::chrono::steady_clock::now().time_since_epoch());
}

}  // namespace furrow::server
