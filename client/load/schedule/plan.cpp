// SPDX-License-Identifier: Apache-2.0
#include "client/load/schedule/plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace furrow::load {
namespace {

// Seconds between poses of a recording with a single frame.
constexpr double kRestInterval = 1.0 / 60.0;

// The order of the heap: its front, the largest element in this order, is the earliest slot.
bool IsLater(const Plan::Slot& a, const Plan::Slot& b) {
  return std::tie(a.due_us, a.subject) > std::tie(b.due_us, b.subject);
}

}  // namespace

Plan::Plan(std::span<const double> times, const PlanOptions& options)
    : phases_(std::clamp(options.phases, 1, static_cast<int>(times.size()))),
      seconds_(options.seconds),
      clock_step_us_(std::llround(options.clock_step * 1e6)),
      clock_every_us_(std::max<std::int64_t>(std::llround(options.clock_every * 1e6), 1)) {
  const auto frames = static_cast<double>(times.size());
  // The average interval of the recording, which also separates two rounds.
  const double own =
      times.size() > 1 ? (times.back() - times.front()) / (frames - 1.0) : kRestInterval;
  const double interval = options.rate > 0.0 ? 1.0 / options.rate : own;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double at =
        options.rate > 0.0 ? static_cast<double>(i) * interval : times[i] - times.front();
    // Rounded once per frame and not per pose, so that every round has exactly the same steps, and
    // the expected weights of one round hold for all.
    frame_us_.push_back(std::llround(at * 1e6));
  }
  round_us_ = std::max<std::int64_t>(frame_us_.back() + std::llround(interval * 1e6), 1);
  const std::int64_t end = std::llround(options.seconds * 1e6);
  for (int subject = 0; subject < options.subjects; ++subject) {
    // Spread over one interval: a burst of all subjects at once would measure the queue, not the
    // server.
    offset_us_.push_back(std::llround(interval * 1e6 * subject / options.subjects));
    counts_.push_back(CountBefore(static_cast<std::uint32_t>(subject), end));
    num_slots_ += counts_.back();
  }
}

// Due times of a subject increase, so a binary search finds the first pose at or after the end.
std::uint32_t Plan::CountBefore(std::uint32_t subject, std::int64_t end_us) const {
  std::uint32_t low = 0;
  std::uint32_t high = std::numeric_limits<std::uint32_t>::max();  // the largest sequence number
  while (low < high) {
    const std::uint32_t middle = low + (high - low) / 2;
    if (DueUs(subject, middle) < end_us) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
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

std::int64_t Plan::ClockOffsetUs(std::uint32_t subject, std::uint32_t pose) const {
  const std::int64_t jumps = DueUs(subject, pose) / clock_every_us_;
  return jumps % 2 == 1 ? clock_step_us_ : 0;
}

double Plan::poses_per_second() const { return static_cast<double>(num_slots_) / seconds_; }

PlanSlots::PlanSlots(const Plan& plan) : plan_(&plan) {
  for (int i = 0; i < plan.num_subjects(); ++i) {
    const auto subject = static_cast<std::uint32_t>(i);
    if (plan.count(subject) > 0) heap_.push_back({plan.DueUs(subject, 0), subject, 0});
  }
  std::ranges::make_heap(heap_, IsLater);
}

void PlanSlots::Pop() {
  std::ranges::pop_heap(heap_, IsLater);
  Plan::Slot& slot = heap_.back();
  // The slot is replaced by the subject's next one, so the heap never grows.
  if (++slot.pose >= plan_->count(slot.subject)) return heap_.pop_back();
  slot.due_us = plan_->DueUs(slot.subject, slot.pose);
  std::ranges::push_heap(heap_, IsLater);
}

}  // namespace furrow::load
