// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "server/core/time.h"

namespace furrow::server {

// Passes at most `max_rate` events per second, evenly spaced and without drift: of a 60 Hz stream,
// a gate of 30 Hz passes every second frame although arrival times jitter. Rate 0 passes
// everything. The lowest rate is one event per hour.
class RateGate {
 public:
  explicit RateGate(double max_rate = 0.0) : period_(PeriodOf(max_rate)) {}

  // Changes the rate, counted from the last event that passed. Repeated calls let nothing extra
  // pass.
  void SetRate(double max_rate) {
    const Time period = PeriodOf(max_rate);
    due_ += period - period_;
    period_ = period;
  }

  // Events per second; 0: all pass.
  [[nodiscard]] double max_rate() const {
    return period_ == Time{0} ? 0.0 : 1.0 / ToSeconds(period_);
  }

  [[nodiscard]] bool Pass(Time now) {
    if (period_ == Time{0}) return true;
    // Events may come a tenth of a period early. Without this tolerance, jitter would reduce 60 Hz
    // to 20 Hz instead of 30 Hz.
    if (started_ && now + period_ / 10 < due_) return false;
    // The next slot follows the schedule, not the late event. A pause restarts the schedule.
    due_ = (started_ && now - due_ < period_) ? due_ + period_ : now + period_;
    started_ = true;
    return true;
  }

 private:
  static Time PeriodOf(double max_rate) {
    constexpr double kMaxPeriod = 3600.0;  // seconds
    return max_rate > 0.0 ? FromSeconds(std::min(1.0 / max_rate, kMaxPeriod)) : Time{0};
  }

  Time period_;
  Time due_{0};
  bool started_ = false;
};

}  // namespace furrow::server
