// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace furrow::protocol::secure {

// At most `per_second` events per second, of which `per_second` may come at once.
class RateBudget {
 public:
  explicit RateBudget(std::uint32_t per_second)
      : per_second_(per_second), level_(std::int64_t{per_second} * kUnit) {}

  // Takes one event from the budget. False, without effect, if it is used up. Threads that share a
  // budget read the clock before they wait for each other, so a time may be older than the last
  // one; it gives nothing, and no time counts twice.
  [[nodiscard]] bool Take(std::int64_t now_us) {
    const std::int64_t passed = std::clamp<std::int64_t>(now_us - last_us_, 0, kUnit);
    level_ = std::min(per_second_ * kUnit, level_ + passed * per_second_);
    last_us_ = std::max(last_us_, now_us);
    if (level_ < kUnit) return false;
    level_ -= kUnit;
    return true;
  }

 private:
  static constexpr std::int64_t kUnit = 1'000'000;  // one event; also the microseconds in a second

  std::int64_t per_second_;
  std::int64_t level_;
  std::int64_t last_us_ = 0;
};

}  // namespace furrow::protocol::secure
