// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "protocol/messages/limits.h"
#include "protocol/secure/crypto/primitives.h"

// The outside of secure datagrams (STANDARD.md section 15). Integers are little-endian.
namespace furrow::protocol::secure {

// The first byte of a secure datagram, without kPhaseBit. Plain messages begin with 'F' (0x46).
enum class PacketKind : std::uint8_t {
  kInitiation = 1,  // client: token, cookie, first handshake message
  kRetry = 2,       // server: a cookie
  kResponse = 3,    // server: second handshake message
  kRefused = 4,     // server: a hint why it does not answer
  kData = 5,        // either: one datagram of the wire, sealed
  kControl = 6,     // either: a message of the session itself, sealed (control.h)
};

inline constexpr std::uint8_t kPhaseBit = 0x80;  // of the first byte of data and control packets

// Header of data and control packets: kind and phase, 3 zero bytes, u32 index of the session at the
// receiver, u64 counter.
inline constexpr std::size_t kPacketHeaderBytes = 16;
inline constexpr std::size_t kPacketOverheadBytes = kPacketHeaderBytes + kTagBytes;
inline constexpr std::size_t kMaxPacketBytes = kMaxDatagramBytes + kPacketOverheadBytes;
static_assert(kMaxPacketBytes == 1232);  // the payload of UDP in the smallest IPv6 packet

// The largest number of packets in one direction of a session. Noise reserves the last nonce.
inline constexpr std::uint64_t kMaxCounter = ~std::uint64_t{0} - 1;

// True if a datagram is one of this section, whatever else may be wrong with it.
[[nodiscard]] inline bool IsSecure(ByteView datagram) {
  if (datagram.empty()) return false;
  const int kind = datagram[0] & ~int{kPhaseBit};
  return kind >= static_cast<int>(PacketKind::kInitiation) &&
         kind <= static_cast<int>(PacketKind::kControl);
}

struct PacketHeader {
  PacketKind kind = PacketKind::kData;
  bool phase = false;
  std::uint32_t index = 0;
  std::uint64_t counter = 0;
};

// Writes the header to the first bytes of `packet`.
void WritePacketHeader(const PacketHeader& header, ByteSpan packet);
// Reads the header of a data or control packet. False for another kind, a wrong size, or a byte
// that must be 0 and is not.
[[nodiscard]] bool ReadPacketHeader(ByteView packet, PacketHeader& header);

// The first 8 bytes of the other kinds: the kind, 3 zero bytes, a u32 index. False as above.
inline constexpr std::size_t kShortHeaderBytes = 8;
void WriteShortHeader(PacketKind kind, std::uint32_t index, ByteSpan packet);
[[nodiscard]] bool ReadShortHeader(ByteView packet, PacketKind kind, std::uint32_t& index);

}  // namespace furrow::protocol::secure
