// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "server/session/time.h"

namespace furrow::server {

// How a subject's poses come, for whoever looks at it: rate, gaps, jitter.
class SubjectStats {
 public:
  // A pose that was used.
  void OnPose(std::uint32_t sequence, std::int64_t capture_time_us, Time now);
  // One that came too late, or twice.
  void OnLate() { ++late_; }

  [[nodiscard]] std::uint64_t poses() const { return poses_; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }  // gaps in the sequence
  [[nodiscard]] std::uint64_t late() const { return late_; }
  // Interarrival jitter as RFC 3550 section 6.4.1 estimates it: how unevenly poses arrive, measured
  // against when they were captured.
  [[nodiscard]] double jitter_seconds() const { return jitter_; }
  // Over the last whole second with poses; 0 when that is longer ago than two.
  [[nodiscard]] double rate_hz(Time now) const;

 private:
  std::uint64_t poses_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t late_ = 0;
  double jitter_ = 0.0;
  double rate_ = 0.0;
  std::uint32_t sequence_ = 0;
  std::int64_t capture_time_us_ = 0;
  Time arrival_{0};
  Time window_{0};
  std::uint64_t in_window_ = 0;
};

}  // namespace furrow::server
