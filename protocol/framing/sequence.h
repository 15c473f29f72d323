// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace furrow::protocol {

enum class SequenceStatus : std::uint8_t {
  kNewest = 0,  // use the pose
  kRestart,     // use the pose and reset the state: it is the stream's or a session's first pose
  kLate,        // drop the pose: a newer one was used
  kDuplicate,   // drop the pose: it was received before
  kOldSession,  // drop the pose: its session was replaced
};

// Sequences wrap at 2^32: `a` is newer than `b` if a - b, as a signed 32-bit number, is above 0.
[[nodiscard]] inline bool IsNewer(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::int32_t>(a - b) > 0;
}

// Decides which poses of one stream are new, by IsNewer().
class SequenceWindow {
 public:
  // A duplicate at least this far behind the newest pose is reported as kLate.
  static constexpr std::uint32_t kWindow = 1024;

  // As if another window had accepted this pose last: it and the ones before it are not new.
  [[nodiscard]] static SequenceWindow After(std::uint64_t session, std::uint32_t sequence);

  // Classifies a pose by the session and sequence of its envelope, and records it.
  [[nodiscard]] SequenceStatus Accept(std::uint64_t session, std::uint32_t sequence);

  // False until the first Accept(). session() and newest() are then 0.
  [[nodiscard]] bool started() const { return started_; }
  [[nodiscard]] std::uint64_t session() const { return session_; }
  [[nodiscard]] std::uint32_t newest() const { return newest_; }
  // Number of sequences skipped in all sessions, minus those that arrived late.
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
