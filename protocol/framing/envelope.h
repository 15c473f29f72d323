// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "protocol/messages/messages.h"

namespace furrow::protocol {

// The 32 bytes before every message, little-endian (STANDARD.md section 2):
//   0 magic "FRRW" | 4 u8 version | 5 u8 flags | 6 u16 stream | 8 u64 session | 16 u32 sequence
//   20 u32 payload size | 24 i64 capture time in microseconds | 32 payload
inline constexpr std::array<std::uint8_t, 4> kMagic = {'F', 'R', 'R', 'W'};
inline constexpr std::uint8_t kVersion = 1;
inline constexpr std::uint8_t kFlagFragment = 1;  // fragment.h
inline constexpr std::uint8_t kFlagFollowed = 2;  // another message follows: bundle.h
inline constexpr std::size_t kEnvelopeBytes = 32;
// A FlatBuffers buffer has at least a root offset and a file identifier.
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
  std::uint8_t flags = 0;
  std::uint32_t payload_bytes = 0;  // of the whole message, also in a fragment
};

// Reads and checks the envelope only, not the payload. Never reads beyond `bytes`.
[[nodiscard]] EnvelopeStatus ReadEnvelope(std::span<const std::uint8_t> bytes, Envelope& envelope);

void WriteEnvelope(const Envelope& envelope, std::span<std::uint8_t, kEnvelopeBytes> out);

}  // namespace furrow::protocol
