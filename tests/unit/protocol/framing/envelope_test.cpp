// SPDX-License-Identifier: Apache-2.0
#include "protocol/framing/envelope.h"

#include <gtest/gtest.h>

#include "tests/unit/protocol/drill.h"

namespace furrow::protocol {
namespace {

std::array<std::uint8_t, kEnvelopeBytes> Good() {
  std::array<std::uint8_t, kEnvelopeBytes> bytes{};
  WriteEnvelope({{0x1122334455667788ULL, 0x99AA, 0xBBCCDDEE, -2}, 0, 0x01020304}, bytes);
  return bytes;
}

TEST(Envelope, BytesMatchTheStandard) {
  const std::array<std::uint8_t, kEnvelopeBytes> expected = {
      'F',  'R',  'R',  'W',  1,    0,    0xAA, 0x99, 0x88, 0x77, 0x66,
      0x55, 0x44, 0x33, 0x22, 0x11, 0xEE, 0xDD, 0xCC, 0xBB, 0x04, 0x03,
      0x02, 0x01, 0xFE, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
  EXPECT_EQ(Good(), expected);
}

TEST(Envelope, RoundTrip) {
  Envelope envelope;
  ASSERT_EQ(ReadEnvelope(Good(), envelope), EnvelopeStatus::kOk);
  EXPECT_EQ(envelope.header, (Header{0x1122334455667788ULL, 0x99AA, 0xBBCCDDEE, -2}));
  EXPECT_EQ(envelope.payload_bytes, 0x01020304u);
}

TEST(Envelope, RejectsEachFault) {
  Envelope envelope;
  const auto read_with = [&envelope](std::size_t at, std::uint8_t value) {
    auto bytes = Good();
    bytes[at] = value;
    return ReadEnvelope(bytes, envelope);
  };
  for (std::size_t at = 0; at < 4; ++at) EXPECT_EQ(read_with(at, 0), EnvelopeStatus::kBadMagic);
  EXPECT_EQ(read_with(4, 0), EnvelopeStatus::kBadVersion);
  EXPECT_EQ(read_with(4, 2), EnvelopeStatus::kBadVersion);
  EXPECT_EQ(read_with(5, 4), EnvelopeStatus::kBadFlags);
  EXPECT_EQ(read_with(5, 0x81), EnvelopeStatus::kBadFlags);
  EXPECT_EQ(read_with(5, kFlagFragment | kFlagFollowed), EnvelopeStatus::kBadFlags);
  EXPECT_EQ(read_with(5, kFlagFragment), EnvelopeStatus::kOk);
  EXPECT_EQ(read_with(5, kFlagFollowed), EnvelopeStatus::kOk);
  auto bytes = Good();
  std::fill(bytes.begin() + 8, bytes.begin() + 16, std::uint8_t{0});
  EXPECT_EQ(ReadEnvelope(bytes, envelope), EnvelopeStatus::kBadSession);
  test::ForEveryTruncation(Good(), [&envelope](std::span<const std::uint8_t> cut) {
    EXPECT_EQ(ReadEnvelope(cut, envelope), EnvelopeStatus::kTooShort);
  });
}

}  // namespace
}  // namespace furrow::protocol
