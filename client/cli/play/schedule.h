// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace furrow::cli {

// Which frame of a recording is sent as the i-th pose, and when. Poses count on beyond the end:
// the recording begins again, a frame's time after its last.
class Schedule {
 public:
  // `rate`: poses a second of recording, each the newest frame at its time; 0: the frames as they
  // are. `times`: of the frames, seconds, increasing; at least one, and they outlive the schedule.
  Schedule(std::span<const double> times, double rate);

  // Poses of one round.
  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] int Frame(std::int64_t pose) const;
  // Of the recording's own time, since its start.
  [[nodiscard]] double Seconds(std::int64_t pose) const;

 private:
  [[nodiscard]] double SecondsInRound(std::int64_t pose) const;

  [[nodiscard]] double duration() const { return times_.back() - times_.front(); }

  std::span<const double> times_;
  double rate_;
  std::int64_t count_;
  double round_seconds_;  // from the start of one round to the next
};

}  // namespace furrow::cli
