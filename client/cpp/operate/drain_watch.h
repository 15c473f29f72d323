// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "protocol/messages/cluster_messages.h"

namespace furrow::client {

// Decides how long a client waits for a daemon that gives its subjects away. No clock.
class DrainWatch {
 public:
  // For the first answer.
  static constexpr std::int64_t kPatienceUs = 3'000'000;
  // After this time without an answer, the daemon or its computer is gone. Over UDP, nothing else
  // says so.
  static constexpr std::int64_t kSilenceUs = 10'000'000;

  // `waits`: for all subjects, at most until `limit_us` after the start; 0: without limit.
  DrainWatch(std::int64_t start_us, bool waits, std::int64_t limit_us)
      : start_us_(start_us), waits_(waits), limit_us_(limit_us) {}

  enum class Verdict : std::uint8_t {
    kGoesOn,
    kNoAnswer,  // the daemon has never answered
    kAgreed,    // the daemon drains, and nobody waits for the end
    kEmpty,     // no subject is left
    kSilent,    // the daemon no longer answers
    kTimedOut,  // subjects are left at the limit
  };
  // `state`: the newest answer, which came at `heard_us`; nothing before the first.
  [[nodiscard]] Verdict Judge(const std::optional<protocol::DrainState>& state,
                              std::int64_t heard_us, std::int64_t now_us) const;

 private:
  const std::int64_t start_us_;
  const bool waits_;
  const std::int64_t limit_us_;
};

}  // namespace furrow::client
