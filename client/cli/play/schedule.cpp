// SPDX-License-Identifier: Apache-2.0
#include "client/cli/play/schedule.h"

#include <algorithm>
#include <cmath>

namespace furrow::cli {
namespace {

constexpr double kSingleFrameSeconds = 1.0 / 30.0;  // length of a recording with one frame

}  // namespace

Schedule::Schedule(std::span<const double> times, double rate) : times_(times), rate_(rate) {
  if (rate > 0.0) {
    count_ = static_cast<std::int64_t>(std::floor(duration() * rate + 1e-6)) + 1;
    round_seconds_ = static_cast<double>(count_) / rate;
    return;
  }
  count_ = static_cast<std::int64_t>(times_.size());
  round_seconds_ = duration() + (count_ > 1 ? duration() / static_cast<double>(count_ - 1)
                                            : kSingleFrameSeconds);
}

double Schedule::SecondsInRound(std::int64_t pose) const {
  if (rate_ > 0.0) return static_cast<double>(pose) / rate_;
  return times_[static_cast<std::size_t>(pose)] - times_.front();
}

int Schedule::Frame(std::int64_t pose) const {
  const std::int64_t in_round = pose % count_;
  if (rate_ <= 0.0) return static_cast<int>(in_round);
  // The offset keeps rounding from missing a frame at its own time.
  const double time = times_.front() + SecondsInRound(in_round) + 1e-9;
  const auto after = std::upper_bound(times_.begin(), times_.end(), time);
  return static_cast<int>(after - times_.begin()) - 1;
}

double Schedule::Seconds(std::int64_t pose) const {
  return static_cast<double>(pose / count_) * round_seconds_ + SecondsInRound(pose % count_);
}

}  // namespace furrow::cli
