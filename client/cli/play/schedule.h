// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace furrow::cli {

// Computes the frame and the time of each pose of a recording that repeats. A round is one pass
// through the recording. The next round starts one frame interval after the last frame. Poses are
// numbered from 0 and keep counting over all rounds.
class Schedule {
 public:
  // `rate`: poses per second of recording, each with the newest frame at its time; 0: every frame.
  // `times`: frame times in seconds, increasing, at least one; they must outlive the schedule.
  Schedule(std::span<const double> times, double rate);

  // Number of poses per round.
  [[nodiscard]] std::int64_t count() const { return count_; }
  // The frame of a pose, an index into `times`.
  [[nodiscard]] int Frame(std::int64_t pose) const;
  // Time of a pose in seconds since the start of the recording, over all rounds.
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
