// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "server/core/time.h"

namespace furrow::server {

// How a subject's poses come, for whoever looks at it: rate, gaps, jitter.
//
// A pose with the capture time of the one before repeats it (a timeline that stands still says so
// ten times a second): it counts as a pose, not as one more that was captured. Where nothing is
// captured for a second, rate and jitter are 0 and begin anew.
class SubjectStats {
 public:
  // A pose that was used. `capture_time_us` 0: it has none.
  void OnPose(std::uint32_t sequence, std::int64_t capture_time_us, Time now);
  // One that came too late, or twice.
  void OnLate() { ++late_; }

  [[nodiscard]] std::uint64_t poses() const { return poses_; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }  // gaps in the sequence
  [[nodiscard]] std::uint64_t late() const { return late_; }
  // Interarrival jitter as RFC 3550 section 6.4.1 estimates it: how unevenly poses arrive, measured
  // against when they were captured. What is sent evenly at another pace than it was captured (slow
  // motion) has none.
  [[nodiscard]] double jitter_seconds(Time now) const { return IsSilent(now) ? 0.0 : jitter_; }
  // Poses captured a second, over the last whole second.
  [[nodiscard]] double rate_hz(Time now) const { return IsSilent(now) ? 0.0 : rate_; }

 private:
  [[nodiscard]] bool IsSilent(Time now) const;
  void CountLost(std::uint32_t sequence);
  void CountRate(Time now);
  void MeasureJitter(double arrived, double captured);

  std::uint64_t poses_ = 0;
  std::uint64_t captured_ = 0;  // of them, those that repeat none
  std::uint64_t lost_ = 0;
  std::uint64_t late_ = 0;
  std::uint32_t sequence_ = 0;
  // Of the last pose that was captured.
  std::int64_t capture_time_us_ = 0;
  Time arrival_{0};

  double rate_ = 0.0;
  Time window_{0};
  std::uint64_t in_window_ = 0;

  // Smoothed seconds between poses; 0: none measured yet.
  double arrives_every_ = 0.0;
  double captured_every_ = 0.0;
  double jitter_ = 0.0;
};

}  // namespace furrow::server
