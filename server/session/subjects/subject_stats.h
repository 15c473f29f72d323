// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "server/core/time.h"

namespace furrow::server {

// Statistics of a subject's stream: rate, losses and jitter.
//
// A pose with the capture time of the previous pose repeats it, as a paused recording does. It
// counts as a pose but not as a captured one. After a second without a captured pose, rate and
// jitter are 0 and start again.
class SubjectStats {
 public:
  // Counts a pose that was solved. `capture_time_us`: on the sender's clock; 0: none. `now`:
  // arrival.
  void OnPose(std::uint32_t sequence, std::int64_t capture_time_us, Time now);
  // Counts a late or duplicate pose.
  void OnLate() { ++late_; }

  [[nodiscard]] std::uint64_t poses() const { return poses_; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }  // missing sequence numbers
  [[nodiscard]] std::uint64_t late() const { return late_; }
  // Interarrival jitter in seconds, estimated as in RFC 3550 section 6.4.1: arrival intervals
  // compared with capture intervals. Evenly played slow motion has no jitter.
  [[nodiscard]] double jitter_seconds(Time now) const { return IsSilent(now) ? 0.0 : jitter_; }
  // Captured poses per second, over the last whole second.
  [[nodiscard]] double rate_hz(Time now) const { return IsSilent(now) ? 0.0 : rate_; }

 private:
  [[nodiscard]] bool IsSilent(Time now) const;
  void CountLost(std::uint32_t sequence);
  void CountRate(Time now);
  void MeasureJitter(double arrived, double captured);

  std::uint64_t poses_ = 0;
  std::uint64_t captured_ = 0;  // poses that did not repeat the previous one
  std::uint64_t lost_ = 0;
  std::uint64_t late_ = 0;
  std::uint32_t sequence_ = 0;
  // Of the last captured pose.
  std::int64_t capture_time_us_ = 0;
  Time arrival_{0};

  double rate_ = 0.0;
  Time window_{0};
  std::uint64_t in_window_ = 0;

  // Smoothed seconds between poses; 0: not measured yet.
  double arrives_every_ = 0.0;
  double captured_every_ = 0.0;
  double jitter_ = 0.0;
};

}  // namespace furrow::server
