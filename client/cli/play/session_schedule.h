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

// What is sent next, out of the recordings of one or several subjects that were captured together.
// When all have ended they begin again together.
class SessionSchedule {
 public:
  struct Track {
    std::span<const double> times;  // of its frames, seconds, increasing; outlive the schedule
    double start = 0.0;             // of its first frame in the session, seconds, >= 0
  };
  struct Due {
    std::size_t track = 0;
    int frame = 0;         // of the track
    double seconds = 0.0;  // of the session since what comes first, >= 0; goes on in later rounds
    std::int64_t round = 0;
  };

  // `rate`: as Schedule's. `from`: seconds of the session to leave out. At least one track.
  SessionSchedule(std::span<const Track> tracks, double rate, double from);

  // Poses of one round; 0: the session ends before `from`.
  [[nodiscard]] std::int64_t count() const { return count_; }
  // Seconds from the session's start to its last frame, whatever `from`.
  [[nodiscard]] double duration() const { return duration_; }
  // The next one, ties by track; none where every track was dropped or ends before `from`.
  [[nodiscard]] std::optional<Due> Next();
  // Leaves a track out from now on.
  void Drop(std::size_t track) { tracks_[track].dropped = true; }

 private:
  struct State {
    std::optional<Schedule> schedule;  // none: ends before `from`
    int first = 0;                     // frame
    double start = 0.0;                // in the round
    std::int64_t next = 0;
    bool dropped = false;
  };
  struct Waiting {
    double seconds = 0.0;
    std::size_t track = 0;
    friend bool operator<(const Waiting& a, const Waiting& b) {  // the earliest on top
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
