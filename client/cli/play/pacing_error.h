// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace furrow::cli {

// Statistics of how precisely poses were sent in time. The error of an interval between two poses
// is the magnitude of its actual minus its intended length.
class PacingError {
 public:
  // Adds a pose that was due at `due_us` and sent at `sent_us`.
  void Sent(std::int64_t due_us, std::int64_t sent_us) {
    const std::int64_t late = sent_us - due_us;
    if (count_++ > 0) {
      const std::int64_t error = std::abs(late - last_late_);
      ++intervals_;
      total_us_ += error;
      largest_us_ = std::max(largest_us_, error);
    }
    last_late_ = late;
  }
  // Adds the intervals of another stream.
  void Add(const PacingError& other) {
    count_ += other.count_;
    intervals_ += other.intervals_;
    total_us_ += other.total_us_;
    largest_us_ = std::max(largest_us_, other.largest_us_);
  }
  // The number of poses.
  [[nodiscard]] std::int64_t count() const { return count_; }
  // The mean and the largest error of an interval, milliseconds; 0 without intervals.
  [[nodiscard]] double mean_ms() const {
    return intervals_ > 0 ? static_cast<double>(total_us_) / static_cast<double>(intervals_) * 1e-3
                          : 0.0;
  }
  [[nodiscard]] double largest_ms() const { return static_cast<double>(largest_us_) * 1e-3; }

 private:
  std::int64_t count_ = 0;
  std::int64_t intervals_ = 0;
  std::int64_t last_late_ = 0;
  std::int64_t total_us_ = 0;
  std::int64_t largest_us_ = 0;
};

}  // namespace furrow::cli
