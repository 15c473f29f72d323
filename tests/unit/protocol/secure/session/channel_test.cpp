// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/session/channel.h"

#include <gtest/gtest.h>

#include "tests/unit/protocol/secure/secure_testing.h"

namespace furrow::protocol::secure {
namespace {

using test::Bytes;

TEST(Control, EveryTypeHasOneSize) {
  ControlMessage message;
  EXPECT_FALSE(ReadControl({}, message));
  for (int type = 0; type < 256; ++type) {
    const int expected = ControlContentBytes(static_cast<std::uint8_t>(type));
    EXPECT_EQ(expected >= 0, type >= 1 && type <= 7) << type;
    for (int size = 0; size < 300; ++size) {
      Bytes inner(static_cast<std::size_t>(1 + size));
      inner[0] = static_cast<std::uint8_t>(type);
      ASSERT_EQ(ReadControl(inner, message), size == expected) << type << " " << size;
    }
  }
}

TEST(Control, CrossesAChannel) {
  test::RepeatableRandom random;
  SessionKeys keys{random.MakeKey(), random.MakeKey(), {}};
  Channel here(keys, 3, 0);
  std::swap(keys.send, keys.receive);
  Channel there(keys, 4, 0);
  Bytes packet(kMaxPacketBytes, 0xEE);
  const Bytes cookie(kCookieBytes, 5);
  const std::size_t size = here.SealControl(ControlType::kPathAnswer, cookie, packet, 0);
  ASSERT_EQ(size, ControlPacketBytes(kCookieBytes));
  packet.resize(size);
  OpenedPacket opened;
  ASSERT_EQ(there.opener.Open(packet, 0, opened), OpenStatus::kOk);
  EXPECT_EQ(opened.kind, PacketKind::kControl);
  ControlMessage message;
  ASSERT_TRUE(ReadControl(opened.inner, message));
  EXPECT_EQ(message.type, ControlType::kPathAnswer);
  EXPECT_EQ(Bytes(message.content.begin(), message.content.end()), cookie);
}

TEST(Control, AProofIsForOneSessionAndOneToken) {
  test::RepeatableRandom random;
  const Key key = random.MakeKey();
  Hash hash{};
  const Mac proof = RenewalProof(key, hash);
  EXPECT_EQ(RenewalProof(key, hash), proof);
  EXPECT_NE(RenewalProof(random.MakeKey(), hash), proof);
  hash[31] ^= 1;
  EXPECT_NE(RenewalProof(key, hash), proof);
}

}  // namespace
}  // namespace furrow::protocol::secure
