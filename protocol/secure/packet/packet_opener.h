// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "protocol/secure/crypto/primitives.h"
#include "protocol/secure/packet/packet.h"
#include "protocol/secure/packet/replay_window.h"

namespace furrow::protocol::secure {

enum class OpenStatus : std::uint8_t {
  kOk = 0,
  kBadHeader,       // wrong kind or size, or a reserved byte that is not 0
  kUnknownSession,  // no session has this index (reported by the tables of sessions)
  kDuplicate,       // this counter was received before
  kTooOld,          // 1,024 or more newer counters were received
  kOldKey,          // sealed with a key that was replaced more than 2 s ago
  kNotAuthentic,    // forged or changed
  kExhausted,       // the limit of failed attempts is reached; the session must end
};
inline constexpr std::size_t kNumOpenStatuses = 8;

// How long packets of the former key are accepted after the first packet of the next key.
inline constexpr std::int64_t kOldKeyMicroseconds = 2'000'000;
// Forgeries after which a session must end (RFC 9001 section 6.6, for this cipher).
inline constexpr std::uint64_t kMaxFailedOpens = std::uint64_t{1} << 36;

// An opened packet.
struct OpenedPacket {
  PacketKind kind = PacketKind::kData;
  std::uint64_t counter = 0;
  ByteSpan inner;  // inside of the packet's buffer
};

// The receiving side of a session: opens packets in place, without allocations. Nothing but the
// count of failures changes before the tag is known to be good.
class PacketOpener {
 public:
  explicit PacketOpener(const Key& key, std::uint64_t max_failures = kMaxFailedOpens);

  // What another process needs to go on with the session.
  struct State {
    Key previous;
    Key current;
    bool phase = false;
    bool has_previous = false;
    std::uint64_t phase_first_counter = 0;
    std::int64_t turned_us = 0;
    ReplayWindow::State window;
    std::uint64_t failures = 0;
  };
  explicit PacketOpener(const State& state, std::uint64_t max_failures = kMaxFailedOpens);
  [[nodiscard]] State state() const;

  // On failure, the inner bytes are unspecified (never plain text).
  [[nodiscard]] OpenStatus Open(ByteSpan packet, std::int64_t now_us, OpenedPacket& opened);

  [[nodiscard]] std::uint64_t num_failures() const { return failures_; }

 private:
  [[nodiscard]] const Key* KeyFor(const PacketHeader& header, std::int64_t now_us) const;
  void TurnTo(const PacketHeader& header, std::int64_t now_us);

  Key previous_;
  Key current_;
  Key next_;  // computed in advance, so that a forged phase costs no more than another forgery
  bool phase_ = false;
  bool has_previous_ = false;
  std::uint64_t phase_first_counter_ = 0;  // of the packets received in this phase, the first
  std::int64_t turned_us_ = 0;
  ReplayWindow window_;
  std::uint64_t failures_ = 0;
  std::uint64_t max_failures_;
};

}  // namespace furrow::protocol::secure
