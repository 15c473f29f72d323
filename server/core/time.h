// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace furrow::server {

// A moment on the daemon's steady clock. Only the network layer reads the clock (net/clock.h); all
// other code receives the time as a `now` argument, so tests choose it.
using Time = std::chrono::nanoseconds;

// Conversions; fractions of a nanosecond or microsecond are truncated.
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
