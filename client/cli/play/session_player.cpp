// SPDX-License-Identifier: Apache-2.0
#include "client/cli/play/session_player.h"

#include <algorithm>
#include <chrono>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <string>
#include <thread>
#include <utility>

#include "base/text.h"
#include "client/cli/common/endpoint.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/interrupt.h"
#include "client/cli/common/progress.h"

namespace furrow::cli {

using client::IoStatus;
using std::chrono::microseconds;
using std::chrono::milliseconds;

SessionPlayer::SessionPlayer(client::Publisher& publisher, std::vector<Track> tracks,
                             SessionSchedule schedule, const Options& options)
    : publisher_(publisher),
      tracks_(std::move(tracks)),
      schedule_(std::move(schedule)),
      options_(options),
      pacing_(tracks_.size()) {}

int SessionPlayer::Run() {
  Play();
  return Report();
}

void SessionPlayer::Play() {
  // Capture times are wall-clock times, which other machines can compare. Sending follows the
  // steady clock, which nobody can set.
  const std::int64_t capture_start = SystemMicroseconds();
  const std::int64_t send_start = SteadyMicroseconds();
  Progress progress("playing", schedule_.count());
  std::int64_t sent = 0;
  protocol::PoseFrame pose;
  while (const auto next = schedule_.Next()) {
    if (next->round > 0 && !options_.loop) break;
    const Track& track = tracks_[next->track];
    // From the start, not from the last pose, so that delays do not add up.
    const std::int64_t due = send_start + std::llround(next->seconds * 1e6 / options_.speed);
    if (!WaitUntil(due)) break;
    // Another sender may have taken over one subject; the others go on.
    if (!publisher_.rejection(track.stream).empty()) {
      schedule_.Drop(next->track);
      continue;
    }
    track.source->Fill(next->frame, &pose);
    // The pacing error is measured before Send(), which may block over TCP.
    pacing_[next->track].Sent(due, SteadyMicroseconds());
    const IoStatus sent_as =
        publisher_.Send(track.stream, pose, capture_start + std::llround(next->seconds * 1e6),
                        options_.encoding, options_.redundant);
    // A datagram that was sent proves no connection; an answer that Poll() reads does.
    if (sent_as != IoStatus::kOk) Note(sent_as);
    if (notes_.lost()) ++unsent_;
    progress.Set(sent++ % schedule_.count() + 1);
  }
}

// Reads answers while waiting, because a restarted daemon asks for the skeletons again. Returns
// false if the connection is closed or an interrupt arrived.
bool SessionPlayer::WaitUntil(std::int64_t due_us) {
  constexpr std::int64_t kLongestWait = 100'000;  // microseconds between checks for interrupts
  Note(publisher_.Poll(SteadyMicroseconds(), milliseconds(0)));
  for (;;) {
    if (closed_ || Interrupted()) return false;
    const std::int64_t now = SteadyMicroseconds();
    if (now >= due_us) return true;
    const microseconds wait(std::min(due_us - now, kLongestWait));
    const auto whole = std::chrono::duration_cast<milliseconds>(wait);
    const IoStatus status = whole.count() > 0 ? publisher_.Poll(now, whole) : IoStatus::kTimeout;
    Note(status);
    // A refusal returns at once, and Poll() cannot wait for less than a millisecond.
    if (whole.count() == 0 || status == IoStatus::kNoConnection) std::this_thread::sleep_for(wait);
  }
}

void SessionPlayer::Note(IoStatus status) {
  closed_ = closed_ || status == IoStatus::kClosed || status == IoStatus::kMalformed;
  // The daemon may come back, so a closed port does not end the playback.
  if (status == IoStatus::kNoConnection) {
    closed_ = closed_ || options_.once;
    if (!options_.once) notes_.Lost();
    // Over TCP, the daemon says it in an error.
    refusal_.Show(publisher_.needs_token() ? publisher_.last_error() : publisher_.refusal());
  } else if (status == IoStatus::kOk) {
    notes_.Connected();
  }
}

int SessionPlayer::Report() const {
  if (closed_) {
    std::fprintf(stderr, "furrow: the connection was lost\n");
    return kNoConnection;
  }
  int exit_code = kDone;
  PacingError pacing;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    pacing.Add(pacing_[i]);
    const std::string& why = publisher_.rejection(tracks_[i].stream);
    if (why.empty()) continue;
    std::fprintf(stderr, "furrow: the daemon rejects further poses of '%s': %s\n",
                 tracks_[i].source->subject().c_str(), why.c_str());
    exit_code = kFailed;
  }
  if (unsent_ > 0) {
    std::fprintf(stderr, "furrow: there was no connection for %" PRId64 " of %s\n", unsent_,
                 Counted(pacing.count(), "pose").c_str());
    if (notes_.lost()) return kNoConnection;
  }
  std::string poses = Counted(pacing.count(), "pose");
  if (tracks_.size() > 1) poses += " of " + std::to_string(tracks_.size()) + " subjects";
  std::fprintf(stderr, "furrow: %s; pacing error %.3f ms on average, %.3f ms at most\n",
               poses.c_str(), pacing.mean_ms(), pacing.largest_ms());
  return exit_code;
}

}  // namespace furrow::cli
