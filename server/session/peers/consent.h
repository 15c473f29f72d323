// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "server/core/time.h"

namespace furrow::server {

// Whether a UDP address still wants what the daemon sends to it. An address that was proven once
// may belong to somebody else by now, and what arrives from it may be forged. So the daemon sends
// it challenges, which are numbers in a Ping, and only who receives a challenge can return it in a
// Pong (STANDARD.md section 9).
class Consent {
 public:
  // Between two challenges, and between two when the last answer is older than kOverdue.
  static constexpr Time kInterval = std::chrono::milliseconds(400);
  static constexpr Time kUrgentInterval = std::chrono::milliseconds(100);
  static constexpr Time kOverdue = std::chrono::seconds(1);
  // Frames pause if the last challenge that was answered is older than this.
  static constexpr Time kPause = std::chrono::seconds(2);
  // The most bytes of replies between two answers. A forged request of 100 bytes may ask for a
  // thousand times as much.
  static constexpr std::uint64_t kReplyBytes = 256 * 1024;

  // The address was proven at `now`.
  void Begin(Time now) { answered_ = now; }

  // Spends `bytes` of the replies. False: the reply must not be sent.
  [[nodiscard]] bool Spend(std::uint64_t bytes) {
    if (spent_ + bytes > kReplyBytes) return false;
    spent_ += bytes;
    return true;
  }
  // A request arrived that cannot be served before the next answer.
  void Want() { wanted_ = true; }
  // True if something waits for an answer, or soon will.
  [[nodiscard]] bool wanted() const { return wanted_ || spent_ > kReplyBytes / 2; }

  // True if a challenge is due. Send one with the number that is passed to Sent().
  [[nodiscard]] bool ChallengeDue(Time now) const {
    // Lost challenges must not pause a viewer: with 10% loss each way, four of them are lost in a
    // row every few minutes.
    const Time interval = now - answered_ > kOverdue ? kUrgentInterval : kInterval;
    return now - newest().sent >= interval;
  }
  // Records a challenge: `number` must be unpredictable.
  void Sent(std::int64_t number, Time now) {
    next_ = (next_ + 1) % challenges_.size();
    challenges_[next_] = {number, now};
  }
  // Records an answer. Counts from the time at which the challenge was sent, so that a late answer
  // cannot prolong the consent.
  void Answered(std::int64_t number) {
    for (Challenge& challenge : challenges_) {
      if (challenge.number != number) continue;
      if (challenge.sent > answered_) answered_ = challenge.sent;
      challenge.number.reset();
      spent_ = 0;
      wanted_ = false;
    }
  }

  // The daemon did not run for this long, and could neither send challenges nor read answers.
  void OnStall(Time length) {
    answered_ += length;
    for (Challenge& challenge : challenges_) challenge.sent += length;
  }

  // True if frames may be sent.
  [[nodiscard]] bool Holds(Time now) const { return now - answered_ <= kPause; }
  // When the last challenge that was answered was sent, or when the address was proven.
  [[nodiscard]] Time answered() const { return answered_; }

 private:
  struct Challenge {
    std::optional<std::int64_t> number;  // none: never sent, or answered
    Time sent{-kInterval};
  };
  // As many as can be answered before kPause is over.
  static constexpr std::size_t kRemembered = kPause / kUrgentInterval;

  [[nodiscard]] const Challenge& newest() const { return challenges_[next_]; }

  std::array<Challenge, kRemembered> challenges_;
  std::size_t next_ = 0;  // of the newest
  Time answered_{0};
  std::uint64_t spent_ = 0;  // since the last answer
  bool wanted_ = false;
};

}  // namespace furrow::server
