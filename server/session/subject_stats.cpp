// SPDX-License-Identifier: Apache-2.0
#include "server/session/subject_stats.h"

#include <cmath>

namespace furrow::server {
namespace {

constexpr Time kWindow = FromSeconds(1.0);
constexpr std::uint32_t kLargestGap = 1000;  // beyond it the sender began anew

}  // namespace

void SubjectStats::OnPose(std::uint32_t sequence, std::int64_t capture_time_us, Time now) {
  if (poses_ > 0) {
    const std::uint32_t step = sequence - sequence_;
    const bool goes_on = step > 0 && step <= kLargestGap && capture_time_us >= capture_time_us_;
    if (goes_on) {
      lost_ += step - 1;
      const double captured = static_cast<double>(capture_time_us - capture_time_us_) * 1e-6;
      const double difference = ToSeconds(now - arrival_) - captured;
      jitter_ += (std::fabs(difference) - jitter_) / 16.0;
    }
  }
  if (poses_ == 0 || now - window_ >= 2 * kWindow) {
    rate_ = 0.0;
    window_ = now;
    in_window_ = 0;
  } else if (now - window_ >= kWindow) {
    rate_ = static_cast<double>(in_window_) / ToSeconds(now - window_);
    window_ = now;
    in_window_ = 0;
  }
  ++in_window_;
  ++poses_;
  sequence_ = sequence;
  capture_time_us_ = capture_time_us;
  arrival_ = now;
}

double SubjectStats::rate_hz(Time now) const { return now - window_ > 2 * kWindow ? 0.0 : rate_; }

}  // namespace furrow::server
