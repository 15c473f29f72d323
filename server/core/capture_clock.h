// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>

#include "server/core/time.h"

namespace furrow::server {

// Estimates when a pose would arrive on a network without jitter: its capture time plus the
// smallest difference between arrival and capture of the last seconds. The two clocks may have any
// epochs and may drift against each other.
class CaptureClock {
 public:
  // The smallest difference counts for between one and two of these spans.
  static constexpr std::int64_t kSpanUs = 5'000'000;
  // A pose that is this late means that the sender's clock was set back.
  static constexpr std::int64_t kLeapUs = 1'000'000;

  // Takes a pose and returns its arrival without jitter, at most `now`. `capture_time_us`: of
  // magnitude below 2^62; 0 if the sender states none, and the pose then counts as on time.
  [[nodiscard]] Time Arrival(std::int64_t capture_time_us, Time now) {
    if (capture_time_us == 0) return now;
    const std::int64_t now_us = ToMicroseconds(now);
    const std::int64_t difference = now_us - capture_time_us;
    if (!started_ || difference > Smallest() + kLeapUs) {
      started_ = true;
      since_us_ = now_us;
      smallest_us_ = former_us_ = difference;
    } else if (now_us - since_us_ > kSpanUs) {
      since_us_ = now_us;
      former_us_ = smallest_us_;
      smallest_us_ = difference;
    }
    smallest_us_ = std::min(smallest_us_, difference);
    // How late the pose is, in [0, kLeapUs].
    return now - std::chrono::microseconds(difference - Smallest());
  }

  // Arrival minus capture of a pose without jitter, each on its own clock. Nothing: no pose has
  // stated its capture time.
  [[nodiscard]] std::optional<std::int64_t> difference_us() const {
    return started_ ? std::optional(Smallest()) : std::nullopt;
  }

 private:
  [[nodiscard]] std::int64_t Smallest() const { return std::min(smallest_us_, former_us_); }

  bool started_ = false;
  std::int64_t since_us_ = 0;     // start of the present span
  std::int64_t smallest_us_ = 0;  // arrival minus capture, of the present span
  std::int64_t former_us_ = 0;    // of the span before
};

}  // namespace furrow::server
