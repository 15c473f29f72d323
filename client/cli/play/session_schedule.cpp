// SPDX-License-Identifier: Apache-2.0
#include "client/cli/play/session_schedule.h"

#include <algorithm>
#include <limits>

namespace furrow::cli {

SessionSchedule::SessionSchedule(std::span<const Track> tracks, double rate, double from) {
  // The first pose that is played is at time 0, also after --from.
  double earliest = std::numeric_limits<double>::infinity();
  for (const Track& track : tracks) {
    Add(track, rate, from);
    if (tracks_.back().schedule) earliest = std::min(earliest, tracks_.back().start);
  }
  for (State& track : tracks_) {
    if (!track.schedule) continue;
    track.start -= earliest;
    count_ += track.schedule->count();
    round_seconds_ =
        std::max(round_seconds_, track.start + track.schedule->Seconds(track.schedule->count()));
  }
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (tracks_[i].schedule) Wait(i);
  }
}

void SessionSchedule::Add(const Track& track, double rate, double from) {
  const auto& times = track.times;
  duration_ = std::max(duration_, track.start + times.back() - times.front());
  // Tracks that end before `from` have no schedule and are never due.
  const auto first = from > track.start
                         ? std::ranges::lower_bound(times, times.front() + from - track.start)
                         : times.begin();
  State& state = tracks_.emplace_back();
  if (first == times.end()) return;
  state.first = static_cast<int>(first - times.begin());
  state.start = track.start + *first - times.front();
  state.schedule.emplace(times.subspan(static_cast<std::size_t>(state.first)), rate);
}

// Queues the next pose of a track at its time. All tracks repeat with the length of the longest
// one, so that they stay together.
void SessionSchedule::Wait(std::size_t track) {
  const State& state = tracks_[track];
  const std::int64_t count = state.schedule->count();
  const double seconds = static_cast<double>(state.next / count) * round_seconds_ + state.start +
                         state.schedule->Seconds(state.next % count);
  waiting_.push({seconds, track});
}

std::optional<SessionSchedule::Due> SessionSchedule::Next() {
  while (!waiting_.empty()) {
    const auto [seconds, track] = waiting_.top();
    waiting_.pop();
    State& state = tracks_[track];
    if (state.dropped) continue;
    const std::int64_t pose = state.next++;
    Wait(track);
    return Due{track, state.first + state.schedule->Frame(pose), seconds,
               pose / state.schedule->count()};
  }
  return std::nullopt;
}

}  // namespace furrow::cli
