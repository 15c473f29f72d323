// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace furrow::client {

// Says when to try again. The pause doubles with each failure in a row, up to a limit. A random
// part keeps the clients of a restarted daemon from coming back in the same instant.
//
// Time is a parameter: microseconds of any monotonic clock.
class Backoff {
 public:
  // With these limits, a client is back within one second of the daemon.
  struct Limits {
    std::int64_t first_us = 50'000;
    std::int64_t most_us = 800'000;
  };
  // `seed`: of the random part, different for each client.
  Backoff(std::uint64_t seed, const Limits& limits)
      : limits_(limits), pause_us_(limits.first_us), random_(seed | 1) {}

  // An attempt failed, or a connection was lost.
  void Failed(std::int64_t now_us) {
    // Between a half and the whole of the pause (xorshift, Marsaglia 2003).
    random_ ^= random_ << 13;
    random_ ^= random_ >> 7;
    random_ ^= random_ << 17;
    const std::int64_t half = pause_us_ / 2;
    due_us_ = now_us + half + static_cast<std::int64_t>(random_ % (half + 1));
    pause_us_ = std::min(2 * pause_us_, limits_.most_us);
  }
  // The next attempt is not due before `time_us`.
  void NotBefore(std::int64_t time_us) { due_us_ = std::max(due_us_, time_us); }
  // The connection works: the next pause is short again.
  void Succeeded() { pause_us_ = limits_.first_us; }

  // Time until the next attempt is due, microseconds; 0 or less: now.
  [[nodiscard]] std::int64_t Wait(std::int64_t now_us) const { return due_us_ - now_us; }

 private:
  Limits limits_;
  std::int64_t pause_us_;
  std::int64_t due_us_ = INT64_MIN / 2;  // at once
  std::uint64_t random_;
};

}  // namespace furrow::client
