// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/handshake/handshake_packets.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/protocol/drill.h"
#include "tests/unit/protocol/secure/secure_testing.h"

namespace furrow::protocol::secure {
namespace {

using test::Bytes;

TEST(HandshakePackets, RetryRoundTripsAndRefusesOtherSizes) {
  Cookie cookie;
  for (std::size_t i = 0; i < cookie.size(); ++i) cookie[i] = static_cast<std::uint8_t>(i);
  const auto bytes = WriteRetry(0x01020304, cookie);
  EXPECT_EQ(test::ToHex(bytes), "0200000004030201000102030405060708090a0b0c0d0e0f1011121314151617");
  std::uint32_t index = 0;
  Cookie read;
  ASSERT_TRUE(ReadRetry(bytes, index, read));
  EXPECT_EQ(index, 0x01020304u);
  EXPECT_EQ(read, cookie);
  protocol::test::ForEveryTruncation(
      bytes, [&](std::span<const std::uint8_t> cut) { EXPECT_FALSE(ReadRetry(cut, index, read)); });
  Bytes other(bytes.begin(), bytes.end());
  other.push_back(0);
  EXPECT_FALSE(ReadRetry(other, index, read));
  for (const std::size_t at : {0, 1, 2, 3}) {
    other.assign(bytes.begin(), bytes.end());
    other[at] ^= 0x10;
    EXPECT_FALSE(ReadRetry(other, index, read)) << at;
  }
}

TEST(HandshakePackets, RefusedCarriesReasonsOfTheWireOnly) {
  std::uint32_t index = 0;
  Refusal refusal = Refusal::kNone;
  for (int reason = 0; reason < 256; ++reason) {
    const auto bytes = WriteRefused(9, static_cast<Refusal>(reason));
    EXPECT_EQ(ReadRefused(bytes, index, refusal), reason >= 1 && reason <= 9) << reason;
    EXPECT_EQ(index, 9u);
    protocol::test::ForEveryTruncation(bytes, [&](std::span<const std::uint8_t> cut) {
      EXPECT_FALSE(ReadRefused(cut, index, refusal));
    });
  }
}

TEST(HandshakePackets, SomeReasonsPassByThemselves) {
  for (const Refusal refusal : {Refusal::kNone, Refusal::kUnknownSession, Refusal::kBusy}) {
    EXPECT_FALSE(Lasts(refusal)) << RefusalText(refusal);
  }
  for (const Refusal refusal : {Refusal::kUnknownKey, Refusal::kExpired, Refusal::kForgedToken,
                                Refusal::kTokenInUse, Refusal::kFull}) {
    EXPECT_TRUE(Lasts(refusal)) << RefusalText(refusal);
  }
}

TEST(HandshakePackets, EveryReasonHasItsOwnText) {
  std::set<std::string> texts;
  for (std::size_t reason = 0; reason < kNumRefusals; ++reason) {
    texts.insert(RefusalText(static_cast<Refusal>(reason)));
  }
  EXPECT_EQ(texts.size(), kNumRefusals);
}

TEST(HandshakePackets, ThePrologueCoversEverythingBeforeTheMessage) {
  Bytes head(kInitiationMessageAt, 7);
  const auto prologue = PrologueOf(head);
  EXPECT_EQ(std::string(prologue.begin(), prologue.begin() + 16), "furrow secure 1\n");
  for (std::size_t at = 0; at < head.size(); ++at) {
    Bytes changed = head;
    changed[at] ^= 1;
    EXPECT_NE(PrologueOf(changed), prologue);
  }
}

}  // namespace
}  // namespace furrow::protocol::secure
