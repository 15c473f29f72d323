// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace furrow::server {

// A moment on the daemon's steady clock. Nothing below the main loop reads a clock: whoever needs
// to know the time is given `now`.
using Time = std::chrono::nanoseconds;

[[nodiscard]] constexpr double ToSeconds(Time time) {
  return std::chrono::duration<double>(time).count();
}
[[nodiscard]] constexpr Time FromSeconds(double seconds) {
  return std::chrono::duration_cast<Time>(std::chrono::duration<double>(seconds));
}

[[nodiscard]] constexpr std::int64_t ToMicroseconds(Time time) {
  return std::chrono::duration_cast<std::chrono::microseconds>(time).count();
}

}  // namespace furrow::server
