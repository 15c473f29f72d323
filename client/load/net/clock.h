// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace furrow::load {

// On a clock that does not go back. Read by the loops that own sockets alone; all else takes time
// as a parameter.
[[nodiscard]] inline std::int64_t SteadyNanoseconds() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace furrow::load
