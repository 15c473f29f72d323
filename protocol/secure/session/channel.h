// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "protocol/secure/handshake/handshake_packets.h"
#include "protocol/secure/packet/packet_opener.h"
#include "protocol/secure/packet/packet_sealer.h"

namespace furrow::protocol::secure {

// What a control packet says: its first inner byte.
enum class ControlType : std::uint8_t {
  kProbe = 1,  // client: asks for kProbeAnswer; padded to the size of a challenge
  kProbeAnswer = 2,
  kPathChallenge = 3,  // server, to a new address of the client: a cookie
  kPathAnswer = 4,     // client, from there: the cookie
  kRenew = 5,          // client: a new token, and a proof that it knows the token's key
  kRenewed = 6,        // server: u64 expiry that is now in force, u8 refusal
  kClose = 7,          // either: the session has ended
};

// Bytes of content after the type. -1 for an undefined type.
[[nodiscard]] int ControlContentBytes(std::uint8_t type);
inline constexpr std::size_t kRenewBytes = kTokenBytes + kMacBytes;
inline constexpr std::size_t kRenewedBytes = 9;
// Size of a control packet with this content.
[[nodiscard]] constexpr std::size_t ControlPacketBytes(std::size_t content) {
  return kPacketOverheadBytes + 1 + content;
}

// The proof of kRenew: that the sender knows the key of the new token, in this session.
[[nodiscard]] Mac RenewalProof(const Key& token_key, const Hash& handshake_hash);

// One side of an established session: both directions and the hash of their handshake.
struct Channel {
  Channel(const SessionKeys& keys, std::uint32_t peer_index, std::int64_t now_us)
      : sealer(keys.send, peer_index, now_us),
        opener(keys.receive),
        handshake_hash(keys.handshake_hash) {}

  // Goes on where another process has stopped.
  Channel(const PacketSealer::State& seals, const PacketOpener::State& opens, const Hash& hash)
      : sealer(seals), opener(opens), handshake_hash(hash) {}

  // Writes a control packet to the beginning of `packet`, which has room for it. Returns its size,
  // or 0 if the session is exhausted.
  [[nodiscard]] std::size_t SealControl(ControlType type, ByteView content, ByteSpan packet,
                                        std::int64_t now_us);

  PacketSealer sealer;
  PacketOpener opener;
  Hash handshake_hash;
};

// A control message: its type, and exactly the content that the type has.
struct ControlMessage {
  ControlType type = ControlType::kProbe;
  ByteView content;
};
// Reads the inner bytes of a control packet. False for undefined types and other sizes.
[[nodiscard]] bool ReadControl(ByteView inner, ControlMessage& message);

}  // namespace furrow::protocol::secure
