// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "server/core/time.h"

namespace furrow::server {

// Lets at most `max_rate` events a second pass, evenly spaced, without drift: a 60 Hz stream gated
// to 30 Hz passes every second frame even where arrival jitters. 0: everything passes. The slowest
// rate is one an hour.
class RateGate {
 public:
  explicit RateGate(double max_rate = 0.0) : period_(PeriodOf(max_rate)) {}

  // Another rate from the event on that passed last: asking again and again lets nothing more pass.
  void SetRate(double max_rate) {
    const Time period = PeriodOf(max_rate);
    due_ += period - period_;
    period_ = period;
  }

  [[nodiscard]] bool Pass(Time now) {
    if (period_ == Time{0}) return true;
    // A tenth of a period of grace, so that jitter does not turn 30 of 60 into 20 of 60.
    if (started_ && now + period_ / 10 < due_) return false;
    // The next slot counts from this one's schedule, not from its lateness; after a pause it starts
    // anew.
    due_ = (started_ && now - due_ < period_) ? due_ + period_ : now + period_;
    started_ = true;
    return true;
  }

 private:
  static Time PeriodOf(double max_rate) {
    constexpr double kMaxPeriod = 3600.0;  // seconds: what a Time surely holds
    return max_rate > 0.0 ? FromSeconds(std::min(1.0 / max_rate, kMaxPeriod)) : Time{0};
  }

  Time period_;
  Time due_{0};
  bool started_ = false;
};

}  // namespace furrow::server
