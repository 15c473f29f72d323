// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace furrow::protocol::mocap {

// Converts times of a sender's clock, which may restart or pass midnight, to a time that never runs
// backwards. All times are in microseconds; `now_us` is the receiver's clock.
class SourceClock {
 public:
  enum class Order : std::uint8_t { kNewer, kNotNewer };

  // Takes the sender's time `source_us` of a frame that arrived at `now_us`.
  // - Equal to the newest time or at most `tolerance_us` behind it: returns kNotNewer, a late
  // frame.
  // - Further behind, or ahead by more than `tolerance_us` plus the time that passed on the
  //   receiver's clock: the sender's clock was reset. time_us() advances by the receiver's clock.
  // - Otherwise time_us() advances by the sender's clock.
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

  // Takes a frame without a sender's time. time_us() advances by the receiver's clock.
  void AdvanceByArrival(std::int64_t now_us) {
    time_us_ = started_ ? time_us_ + std::max<std::int64_t>(now_us - arrived_us_, 0) : now_us;
    started_ = true;
    has_source_ = false;
    arrived_us_ = now_us;
  }

  // The time of the newest frame. Begins at the first frame's `source_us`, or at `now_us` without.
  [[nodiscard]] std::int64_t time_us() const { return time_us_; }

 private:
  bool started_ = false;
  bool has_source_ = false;      // newest_us_ is valid
  std::int64_t newest_us_ = 0;   // newest frame, on the sender's clock
  std::int64_t arrived_us_ = 0;  // arrival of that frame, on the receiver's clock
  std::int64_t time_us_ = 0;     // output
};

}  // namespace furrow::protocol::mocap
