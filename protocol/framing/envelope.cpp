// SPDX-License-Identifier: Apache-2.0
#include "protocol/framing/envelope.h"

#include <algorithm>

#include "protocol/messages/bytes.h"

namespace furrow::protocol {

EnvelopeStatus ReadEnvelope(std::span<const std::uint8_t> bytes, Envelope& envelope) {
  if (bytes.size() < kEnvelopeBytes) return EnvelopeStatus::kTooShort;
  // Offsets: magic 0, version 4, flags 5, stream 6, session 8, sequence 16, payload size 20,
  // capture time 24; all numbers are little-endian (STANDARD.md).
  const std::uint8_t* at = bytes.data();
  if (!std::equal(kMagic.begin(), kMagic.end(), at)) return EnvelopeStatus::kBadMagic;
  if (at[4] != kVersion) return EnvelopeStatus::kBadVersion;
  if (at[5] != 0 && at[5] != kFlagFragment && at[5] != kFlagFollowed) {
    return EnvelopeStatus::kBadFlags;
  }
  envelope.flags = at[5];
  envelope.header.stream = LoadLittle<std::uint16_t>(at + 6);
  envelope.header.session = LoadLittle<std::uint64_t>(at + 8);
  envelope.header.sequence = LoadLittle<std::uint32_t>(at + 16);
  envelope.payload_bytes = LoadLittle<std::uint32_t>(at + 20);
  envelope.header.capture_time_us = LoadLittle<std::int64_t>(at + 24);
  return envelope.header.session == 0 ? EnvelopeStatus::kBadSession : EnvelopeStatus::kOk;
}

void WriteEnvelope(const Envelope& envelope, std::span<std::uint8_t, kEnvelopeBytes> out) {
  std::uint8_t* at = out.data();
  std::copy(kMagic.begin(), kMagic.end(), at);
  at[4] = kVersion;
  at[5] = envelope.flags;
  StoreLittle(envelope.header.stream, at + 6);
  StoreLittle(envelope.header.session, at + 8);
  StoreLittle(envelope.header.sequence, at + 16);
  StoreLittle(envelope.payload_bytes, at + 20);
  StoreLittle(envelope.header.capture_time_us, at + 24);
}

}  // namespace furrow::protocol
