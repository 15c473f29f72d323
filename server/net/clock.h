// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "server/core/time.h"

namespace furrow::server {

// The daemon's clock. Read here in net/ alone, once a batch of packets; everything below gets
// `now`.
[[nodiscard]] inline Time ReadClock() {
  return std::chrono::duration_cast<Time>(std::chrono::steady_clock::now().time_since_epoch());
}

}  // namespace furrow::server
