// SPDX-License-Identifier: Apache-2.0
#include "client/load/plan.h"

#include <algorithm>
#include <cmath>

namespace furrow::load {
namespace {

// A recording of one frame rests: it is sent as often as most cameras would.
constexpr double kRestInterval = 1.0 / 60.0;

}  // namespace

Plan::Plan(std::span<const double> times, const PlanOptions& options)
    : phases_(std::clamp(options.phases, 1, static_cast<int>(times.size()))),
      seconds_(options.seconds) {
  const auto frames = static_cast<double>(times.size());
  const double own =
      times.size() > 1 ? (times.back() - times.front()) / (frames - 1.0) : kRestInterval;
  const double interval = options.rate > 0.0 ? 1.0 / options.rate : own;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double at =
        options.rate > 0.0 ? static_cast<double>(i) * interval : times[i] - times.front();
    frame_us_.push_back(std::llround(at * 1e6));
  }
  round_us_ = std::max<std::int64_t>(frame_us_.back() + std::llround(interval * 1e6), 1);
  const std::int64_t end = std::llround(options.seconds * 1e6);
  for (int subject = 0; subject < options.subjects; ++subject) {
    offset_us_.push_back(std::llround(interval * 1e6 * subject / options.subjects));
    const auto number = static_cast<std::uint32_t>(subject);
    std::uint32_t pose = 0;
    for (; DueUs(number, pose) < end; ++pose) slots_.push_back({DueUs(number, pose), number, pose});
    counts_.push_back(pose);
  }
  std::ranges::stable_sort(slots_, {}, &Slot::due_us);
}

int Plan::FirstFrame(int phase) const {
  return static_cast<int>(frame_us_.size() * static_cast<std::size_t>(phase) /
                          static_cast<std::size_t>(phases_));
}

int Plan::Frame(int phase, std::uint32_t pose) const {
  return static_cast<int>((static_cast<std::size_t>(FirstFrame(phase)) + pose) % frame_us_.size());
}

std::int64_t Plan::CaptureUs(int phase, std::uint32_t pose) const {
  const auto first = static_cast<std::size_t>(FirstFrame(phase));
  const std::size_t place = first + pose;
  const auto rounds = static_cast<std::int64_t>(place / frame_us_.size());
  return rounds * round_us_ + frame_us_[place % frame_us_.size()] - frame_us_[first];
}

std::int64_t Plan::DueUs(std::uint32_t subject, std::uint32_t pose) const {
  return offset_us_[subject] + CaptureUs(phase_of(subject), pose);
}

double Plan::poses_per_second() const { return static_cast<double>(slots_.size()) / seconds_; }

}  // namespace furrow::load
