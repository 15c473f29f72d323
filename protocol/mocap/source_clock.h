// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace furrow::protocol::mocap {

// Turns a sender's clock, which may restart or pass midnight, into one that never runs backwards.
class SourceClock {
 public:
  enum class Order : std::uint8_t { kNewer, kNotNewer };

  // `source_us` at most `tolerance_us` behind the newest (or equal) is kNotNewer: a straggler.
  // Further behind, or further ahead than what passed on the receiver's clock by more than
  // `tolerance_us`, the clock was set anew: time goes on by what passed on the receiver's.
  [[nodiscard]] Order Advance(std::int64_t source_us, std::int64_t now_us,
                              std::int64_t tolerance_us) {
    const bool follows = started_ && has_source_;
    const std::int64_t step = source_us - newest_us_;
    if (follows && step <= 0 && step >= -tolerance_us) return Order::kNotNewer;
    if (follows && step > 0 && step - (now_us - arrived_us_) <= tolerance_us) {
      time_us_ += step;
      arrived_us_ = now_us;
    } else if (!started_) {
      AdvanceByArrival(now_us);
      time_us_ = source_us;
    } else {
      AdvanceByArrival(now_us);
    }
    has_source_ = true;
    newest_us_ = source_us;
    return Order::kNewer;
  }

  // A frame without a time of the sender's: time goes on by what passed on the receiver's clock.
  void AdvanceByArrival(std::int64_t now_us) {
    time_us_ = started_ ? time_us_ + std::max<std::int64_t>(now_us - arrived_us_, 0) : now_us;
    started_ = true;
    has_source_ = false;
    arrived_us_ = now_us;
  }

  [[nodiscard]] std::int64_t time_us() const { return time_us_; }

 private:
  bool started_ = false;
  bool has_source_ = false;      // newest_us_ counts
  std::int64_t newest_us_ = 0;   // of the sender
  std::int64_t arrived_us_ = 0;  // of the receiver, when that came
  std::int64_t time_us_ = 0;
};

}  // namespace furrow::protocol::mocap
