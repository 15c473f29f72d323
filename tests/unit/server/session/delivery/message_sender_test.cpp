// SPDX-License-Identifier: Apache-2.0
#include "server/session/delivery/message_sender.h"

#include <string>

#include <gtest/gtest.h>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

class MessageSenderTest : public testing::Test {
 protected:
  void SetUp() override { peer.link = &link; }

  Metrics metrics;
  FakePeer link;
  Peer peer;
  MessageSender messages{4242, &metrics};
};

TEST_F(MessageSenderTest, RepliesCarryTheSessionOfTheDaemonAndTheSequenceOfTheRequest) {
  messages.SendReply(peer, MessageSender::ReplyHeader({.session = 9, .stream = 3, .sequence = 5}),
                     protocol::Pong{1, 2});
  const auto pong = link.Take<protocol::Pong>();
  ASSERT_TRUE(pong.has_value());
  EXPECT_EQ(pong->header.session, 4242u);
  EXPECT_EQ(pong->header.stream, 3);
  EXPECT_EQ(pong->header.sequence, 5u);
}

TEST_F(MessageSenderTest, RepliesToAUdpAddressAreBoundedByItsConsent) {
  peer.transport = Transport::kUdp;
  for (int i = 0; i < 10'000; ++i) messages.SendReply(peer, {}, protocol::Pong{1, 2});
  EXPECT_LE(link.bytes_received, Consent::kReplyBytes);
  EXPECT_EQ(metrics.Get(Counter::kRepliesWithoutConsent), 10'000 - link.inbox.size());
  const std::size_t before = link.inbox.size();
  messages.SendChallenge(peer, 5);
  EXPECT_EQ(link.inbox.size(), before + 1) << "or it could never consent again";
  peer.consent.Sent(5, Time{0});
  peer.consent.Answered(5);
  messages.SendReply(peer, {}, protocol::Pong{1, 2});
  EXPECT_EQ(link.inbox.size(), before + 2);
}

TEST_F(MessageSenderTest, LongErrorTextIsCutBetweenCharacters) {
  const std::string text(protocol::kMaxTextBytes - 1, 'x');
  EXPECT_EQ(MessageSender::Truncate(text + "\u00e9"), text) << "the character has 2 bytes";
  EXPECT_EQ(MessageSender::Truncate(text + "e"), text + "e");
}

}  // namespace
}  // namespace furrow::server
