// SPDX-License-Identifier: Apache-2.0
#include "protocol/framing/sequence.h"

#include <algorithm>

namespace furrow::protocol {

SequenceStatus SequenceWindow::Accept(std::uint64_t session, std::uint32_t sequence) {
  if (!started_ || session != session_) {
    // A late datagram of a replaced session must not take the stream back. A few sessions are
    // remembered.
    if (std::find(old_sessions_.begin(), old_sessions_.end(), session) != old_sessions_.end()) {
      return SequenceStatus::kOldSession;
    }
    Start(session, sequence);
    return SequenceStatus::kRestart;
  }
  if (IsNewer(sequence, newest_)) {
    Advance(sequence);
    return SequenceStatus::kNewest;
  }
  const std::uint32_t behind = newest_ - sequence;
  if (behind >= kWindow) return SequenceStatus::kLate;
  if (TestAndSet(sequence)) return SequenceStatus::kDuplicate;
  // A late pose is no longer lost. A pose before the first one was never counted as lost.
  if (IsNewer(sequence, first_) && lost_ > 0) --lost_;
  return SequenceStatus::kLate;
}

SequenceWindow SequenceWindow::After(std::uint64_t session, std::uint32_t sequence) {
  SequenceWindow window;
  window.Start(session, sequence);
  return window;
}

void SequenceWindow::Start(std::uint64_t session, std::uint32_t sequence) {
  if (started_) old_sessions_[next_old_++ % old_sessions_.size()] = session_;
  started_ = true;
  session_ = session;
  newest_ = first_ = sequence;
  seen_.fill(0);
  (void)TestAndSet(sequence);
}

bool SequenceWindow::TestAndSet(std::uint32_t sequence) {
  const std::uint32_t slot = sequence % kWindow;
  std::uint64_t& word = seen_[slot / 64];
  const std::uint64_t bit = std::uint64_t{1} << (slot % 64);
  const bool was_set = (word & bit) != 0;
  word |= bit;
  return was_set;
}

void SequenceWindow::Advance(std::uint32_t sequence) {
  const std::uint32_t skipped = sequence - newest_ - 1;
  lost_ += skipped;
  // Skipped sequences have not been seen. Their slots still hold the bits of sequences one window
  // ago.
  if (skipped + 1 >= kWindow) {
    seen_.fill(0);
  } else {
    for (std::uint32_t s = newest_ + 1; s != sequence; ++s) {
      seen_[s % kWindow / 64] &= ~(std::uint64_t{1} << (s % 64));
    }
    seen_[sequence % kWindow / 64] &= ~(std::uint64_t{1} << (sequence % 64));
  }
  newest_ = sequence;
  (void)TestAndSet(sequence);
}

}  // namespace furrow::protocol
