// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace furrow::net {

// The current time of a monotonic clock, in nanoseconds. Only loops that own sockets call it;
// everything else takes time as a parameter.
[[nodiscard]] inline std::int64_t SteadyNanoseconds() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace furrow::net
