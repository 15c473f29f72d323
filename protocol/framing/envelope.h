// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "protocol/messages/messages.h"

namespace furrow::protocol {

// The envelope is the 32 bytes before the payload of every message (STANDARD.md section 2).
// Integers are little-endian:
//
//   offset  type   field
//   0       u8[4]  magic "FRRW"
//   4       u8     version
//   5       u8     flags
//   6       u16    stream
//   8       u64    session, not 0
//   16      u32    sequence
//   20      u32    payload size of the complete message, in bytes
//   24      i64    capture time in microseconds on the publisher's clock, which may have any epoch
inline constexpr std::array<std::uint8_t, 4> kMagic = {'F', 'R', 'R', 'W'};
inline constexpr std::uint8_t kVersion = 1;
inline constexpr std::uint8_t kFlagFragment = 1;  // one part of a message (fragment.h)
inline constexpr std::uint8_t kFlagFollowed = 2;  // another message follows it in the datagram
inline constexpr std::size_t kEnvelopeBytes = 32;
// The smallest FlatBuffers buffer: a root offset and a file identifier, 4 bytes each.
inline constexpr std::size_t kMinPayloadBytes = 8;

enum class EnvelopeStatus : std::uint8_t {
  kOk = 0,
  kTooShort,  // fewer bytes than an envelope
  kBadMagic,
  kBadVersion,  // a version that this build does not support
  kBadFlags,    // a bit that version 1 does not define, or both bits together
  kBadSession,  // session 0
};

struct Envelope {
  Header header;
  std::uint8_t flags = 0;           // 0, kFlagFragment or kFlagFollowed
  std::uint32_t payload_bytes = 0;  // of the complete message; every fragment carries this total
};

// Reads the envelope at the start of `bytes` and checks magic, version, flags and session. Never
// reads beyond `bytes`. `envelope` is unspecified unless the result is kOk.
[[nodiscard]] EnvelopeStatus ReadEnvelope(std::span<const std::uint8_t> bytes, Envelope& envelope);

// Writes magic, kVersion and the fields of `envelope` to `out`. Does not check them.
void WriteEnvelope(const Envelope& envelope, std::span<std::uint8_t, kEnvelopeBytes> out);

}  // namespace furrow::protocol
