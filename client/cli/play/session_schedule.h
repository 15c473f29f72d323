// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <queue>
#include <span>
#include <vector>

#include "client/cli/play/schedule.h"

namespace furrow::cli {

// The order of the poses of one or more subjects that were captured together. When all recordings
// have ended, all start again together.
class SessionSchedule {
 public:
  struct Track {
    std::span<const double> times;  // frame times, seconds, increasing; must outlive the schedule
    double start = 0.0;             // session time of the first frame, seconds, >= 0
  };
  struct Due {
    std::size_t track = 0;
    int frame = 0;         // of the track
    double seconds = 0.0;  // since the first pose, over all rounds
    std::int64_t round = 0;
  };

  // `rate`: poses per second and track, each with the newest frame at its time; 0: every frame.
  // `from`: seconds of the session to skip. Precondition: at least one track.
  SessionSchedule(std::span<const Track> tracks, double rate, double from);

  // Number of poses per round; 0: the session ends before `from`.
  [[nodiscard]] std::int64_t count() const { return count_; }
  // Seconds from the start of the session to its last frame, regardless of `from`.
  [[nodiscard]] double duration() const { return duration_; }
  // Returns the next pose; equal times are ordered by track. Returns nothing if all tracks were
  // dropped or end before `from`.
  [[nodiscard]] std::optional<Due> Next();
  // Skips a track from now on.
  void Drop(std::size_t track) { tracks_[track].dropped = true; }

 private:
  struct State {
    std::optional<Schedule> schedule;  // none: the track ends before `from`
    int first = 0;                     // first frame to send
    double start = 0.0;                // within a round, seconds
    std::int64_t next = 0;
    bool dropped = false;
  };
  struct Waiting {
    double seconds = 0.0;
    std::size_t track = 0;
    friend bool operator<(const Waiting& a, const Waiting& b) {  // the earliest is on top
      return a.seconds != b.seconds ? a.seconds > b.seconds : a.track > b.track;
    }
  };

  void Wait(std::size_t track);

  void Add(const Track& track, double rate, double from);

  std::vector<State> tracks_;
  std::priority_queue<Waiting> waiting_;
  std::int64_t count_ = 0;
  double duration_ = 0.0;
  double round_seconds_ = 0.0;
};

}  // namespace furrow::cli
