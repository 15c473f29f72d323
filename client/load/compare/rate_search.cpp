// SPDX-License-Identifier: Apache-2.0
#include "client/load/compare/rate_search.h"

#include <algorithm>
#include <cmath>

namespace furrow::load {

void RateSearch::Report(bool sustained) {
  if (done_) return;
  if (sustained) {
    best_ = rate_;
    failures_ = 0;
    Next();
  } else if (++failures_ >= tries_) {
    worst_ = rate_;
    failures_ = 0;
    Next();
  }
}

void RateSearch::Next() {
  if (worst_ == 0.0) {
    done_ = rate_ >= limit_;
    rate_ = std::min(rate_ * 2.0, limit_);
  } else if (best_ == 0.0) {
    // No rate was sustained yet: halve the rate, but stop below one pose per second.
    rate_ = worst_ / 2.0;
    done_ = rate_ < 1.0;
  } else {
    // The geometric mean splits the interval evenly in ratio, as the precision is a ratio, too.
    done_ = worst_ / best_ <= precision_;
    rate_ = std::sqrt(best_ * worst_);
  }
}

}  // namespace furrow::load
