// SPDX-License-Identifier: Apache-2.0
#include "server/session/subjects/subject_stats.h"

#include <cmath>

namespace furrow::server {
namespace {

constexpr Time kWindow = FromSeconds(1.0);
constexpr std::uint32_t kLargestGap = 1000;  // a larger gap is a restart of the sender
constexpr double kSmoothing = 1.0 / 16.0;    // as in RFC 3550

}  // namespace

bool SubjectStats::IsSilent(Time now) const { return captured_ == 0 || now - arrival_ >= kWindow; }

void SubjectStats::OnPose(std::uint32_t sequence, std::int64_t capture_time_us, Time now) {
  // A capture time that goes back means a loop or a restart, and its jump in sequence numbers is
  // not a loss.
  if (poses_ > 0 && capture_time_us >= capture_time_us_) CountLost(sequence);
  ++poses_;
  sequence_ = sequence;
  const bool has_time = capture_time_us != 0;
  if (captured_ > 0 && has_time && capture_time_us == capture_time_us_) return;
  if (IsSilent(now)) {
    rate_ = jitter_ = arrives_every_ = captured_every_ = 0.0;
    window_ = now;
    in_window_ = 0;
  } else {
    CountRate(now);
    const double captured = static_cast<double>(capture_time_us - capture_time_us_) * 1e-6;
    const bool has_both = has_time && capture_time_us_ != 0;
    // Other steps are jumps of a timeline, which say nothing about jitter.
    const bool is_step = captured > 0.0 && captured < ToSeconds(kWindow);
    if (has_both && is_step) MeasureJitter(ToSeconds(now - arrival_), captured);
  }
  ++in_window_;
  ++captured_;
  capture_time_us_ = capture_time_us;
  arrival_ = now;
}

void SubjectStats::CountLost(std::uint32_t sequence) {
  const std::uint32_t step = sequence - sequence_;  // unsigned subtraction: numbers wrap around
  if (step > 0 && step <= kLargestGap) lost_ += step - 1;
}

void SubjectStats::CountRate(Time now) {
  if (now - window_ < kWindow) return;
  rate_ = static_cast<double>(in_window_) / ToSeconds(now - window_);
  window_ = now;
  in_window_ = 0;
}

void SubjectStats::MeasureJitter(double arrived, double captured) {
  if (captured_every_ == 0.0) {
    arrives_every_ = arrived;
    captured_every_ = captured;
    return;
  }
  // RFC 3550 compares intervals directly, which assumes that both clocks run at one speed. The
  // ratio of the smoothed intervals removes a constant difference, as in slow motion.
  arrives_every_ += (arrived - arrives_every_) * kSmoothing;
  captured_every_ += (captured - captured_every_) * kSmoothing;
  const double difference = arrived - captured * (arrives_every_ / captured_every_);
  jitter_ += (std::fabs(difference) - jitter_) * kSmoothing;
}

}  // namespace furrow::server
