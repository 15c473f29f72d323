// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "protocol/secure/crypto/primitives.h"
#include "protocol/secure/packet/packet.h"

namespace furrow::protocol::secure {

// When the sending side changes its key.
struct RekeyLimits {
  std::uint64_t packets = std::uint64_t{1} << 24;
  std::int64_t microseconds = std::int64_t{15} * 60 * 1'000'000;
};

enum class SealStatus : std::uint8_t {
  kOk = 0,
  kNotConnected,  // no session to send in
  kBadSize,       // the packet is too small for header and tag, or larger than kMaxPacketBytes
  kExhausted,     // the last counter is used up; the session must end
};

// The sending side of a session: seals packets in place, without allocations. Each counter is used
// once; counters continue across a change of the key.
class PacketSealer {
 public:
  // `index`: of the session at the receiver. `first_counter` is for tests and vectors.
  PacketSealer(const Key& key, std::uint32_t index, std::int64_t now_us, RekeyLimits limits = {},
               std::uint64_t first_counter = 0);

  // What another process needs to go on with the session. Whoever takes it must not seal again:
  // two packets with the same counter would reveal both.
  struct State {
    Key key;
    std::uint32_t index = 0;
    std::uint64_t counter = 0;
    bool phase = false;
    std::uint64_t phase_packets = 0;
    std::int64_t phase_began_us = 0;
  };
  explicit PacketSealer(const State& state, RekeyLimits limits = {});
  [[nodiscard]] State state() const;

  // `packet` holds the inner bytes after kPacketHeaderBytes, and room for the tag at its end.
  // Writes header and tag, and encrypts the inner bytes.
  [[nodiscard]] SealStatus Seal(PacketKind kind, ByteSpan packet, std::int64_t now_us);

 private:
  void ChangeKeyIfDue(std::int64_t now_us);

  Key key_;
  std::uint32_t index_;
  RekeyLimits limits_;
  std::uint64_t counter_;
  bool phase_ = false;
  std::uint64_t phase_packets_ = 0;
  std::int64_t phase_began_us_;
};

}  // namespace furrow::protocol::secure
