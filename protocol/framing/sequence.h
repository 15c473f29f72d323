// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace furrow::protocol {

enum class SequenceStatus : std::uint8_t {
  kNewest = 0,  // use it
  kRestart,     // use it: the first of a new session (also the very first); forget the old state
  kLate,        // older than what was used already: drop
  kDuplicate,   // seen already: drop
  kOldSession,  // a straggler of a session that was replaced: drop
};

// Which poses of one stream are new. Sequences wrap, so they are compared by subtraction.
class SequenceWindow {
 public:
  static constexpr std::uint32_t kWindow =
      1024;  // duplicates are told from late ones this far back

  // Classifies and remembers.
  [[nodiscard]] SequenceStatus Accept(std::uint64_t session, std::uint32_t sequence);

  [[nodiscard]] bool started() const { return started_; }
  [[nodiscard]] std::uint64_t session() const { return session_; }
  [[nodiscard]] std::uint32_t newest() const { return newest_; }
  // Sequences skipped when newer ones came, less the late ones that did come after all.
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  void Start(std::uint64_t session, std::uint32_t sequence);
  [[nodiscard]] bool TestAndSet(std::uint32_t sequence);
  void Advance(std::uint32_t sequence);

  bool started_ = false;
  std::uint64_t session_ = 0;
  std::uint32_t newest_ = 0;
  std::uint32_t first_ = 0;
  std::uint64_t lost_ = 0;
  std::array<std::uint64_t, 4> old_sessions_{};
  std::uint32_t next_old_ = 0;
  std::array<std::uint64_t, kWindow / 64> seen_{};
};

}  // namespace furrow::protocol
