// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "server/core/time.h"

namespace furrow::server {

// A rate limiter: admits `rate` events per second on average and at most `burst` at once. The
// bucket starts full.
class TokenBucket {
 public:
  // `rate`: tokens per second, > 0. `burst`: capacity in tokens, > 0.
  TokenBucket(double rate, double burst) : rate_(rate), burst_(burst), tokens_(burst) {}

  // Takes `cost` tokens and returns true, or returns false if there are too few. A `now` earlier
  // than the last one adds no tokens.
  [[nodiscard]] bool Take(Time now, double cost = 1.0) {
    if (started_ && now > last_) {
      tokens_ = std::min(burst_, tokens_ + rate_ * ToSeconds(now - last_));
    }
    if (!started_ || now > last_) last_ = now;
    started_ = true;
    if (tokens_ < cost) return false;
    tokens_ -= cost;
    return true;
  }

 private:
  double rate_;
  double burst_;
  double tokens_;
  Time last_{0};
  bool started_ = false;
};

}  // namespace furrow::server
