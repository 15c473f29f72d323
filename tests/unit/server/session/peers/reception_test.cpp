// SPDX-License-Identifier: Apache-2.0
#include "server/session/peers/reception.h"

#include <optional>

#include <gtest/gtest.h>

#include "protocol/framing/fragment.h"
#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

constexpr Time kReceptionNow = FromSeconds(1000);

class ReceptionTest : public testing::Test {
 protected:
  explicit ReceptionTest(bool requires_token = false)
      : reception(4242, &proof, &metrics, requires_token) {}

  template <class Message>
  bool Say(const Message& message, std::uint64_t session = 77) {
    encoder.Encode({.session = session, .stream = 3, .sequence = 9}, message, sent);
    const bool admitted = reception.Admits(address, has_peer, sent, kReceptionNow);
    EXPECT_LE(reception.reply().size(), sent.size()) << "an address that is not proven";
    return admitted;
  }
  template <class Message>
  std::optional<Message> Reply() {
    protocol::MessageView view;
    Message message;
    if (protocol::OpenMessage(reception.reply(), view) != protocol::DecodeStatus::kOk ||
        protocol::Decode(view, message) != protocol::DecodeStatus::kOk) {
      return std::nullopt;
    }
    header = view.header;
    return message;
  }

  Metrics metrics;
  AddressProof proof{AddressProof::Key{9}};
  Reception reception;
  protocol::Encoder encoder;
  std::vector<std::uint8_t> sent;
  UdpAddress address{1, 2, 3};
  bool has_peer = false;
  protocol::Header header;
};

TEST_F(ReceptionTest, TheSecondHelloProvesTheAddress) {
  EXPECT_FALSE(Say(protocol::Hello{"test", 0}));
  const auto welcome = Reply<protocol::Welcome>();
  ASSERT_TRUE(welcome.has_value());
  EXPECT_EQ(header.session, 4242u);
  EXPECT_EQ(header.sequence, 9u);
  EXPECT_FALSE(Say(protocol::Hello{"test", welcome->token + 1}));
  EXPECT_EQ(Reply<protocol::Welcome>()->token, welcome->token) << "a wrong token proves nothing";
  EXPECT_FALSE(Say(protocol::Hello{"test", welcome->token}, 78)) << "another program";
  EXPECT_TRUE(Say(protocol::Hello{"test", welcome->token}));
}

TEST_F(ReceptionTest, EverythingElseIsRefused) {
  EXPECT_FALSE(Say(protocol::SubscribeWeights{.subject = "ann", .pattern = std::string(60, '*')}));
  const auto error = Reply<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->code, protocol::ErrorCode::kUnprovenAddress);
  EXPECT_FALSE(error->message.empty());
  EXPECT_EQ(header.stream, 3);
  EXPECT_EQ(header.sequence, 9u);
  EXPECT_EQ(metrics.Get(Counter::kDatagramsUnproven), 1u);
}

// Two daemons that answered each other's answers would never stop.
TEST_F(ReceptionTest, WhatADaemonSendsIsNotAnswered) {
  Reception other(4343, &proof, &metrics);
  for (const bool hello : {true, false}) {
    if (hello) {
      (void)Say(protocol::Hello{"forged", 0});
    } else {
      (void)Say(protocol::Ping{1});
    }
    ASSERT_FALSE(reception.reply().empty());
    EXPECT_FALSE(other.Admits(address, false, reception.reply(), kReceptionNow));
    EXPECT_TRUE(other.reply().empty());
  }
  (void)Say(protocol::Pong{1, 0});
  EXPECT_TRUE(reception.reply().empty());
  (void)Say(protocol::Goodbye{});
  EXPECT_TRUE(reception.reply().empty());
}

TEST_F(ReceptionTest, APeerIsNotToldOfForgedDatagrams) {
  has_peer = true;
  EXPECT_FALSE(Say(protocol::Ping{5}));
  EXPECT_TRUE(reception.reply().empty()) << "it would start over, again and again";
  EXPECT_FALSE(Say(protocol::Hello{"restarted", 0}));
  EXPECT_TRUE(Reply<protocol::Welcome>().has_value());
}

TEST_F(ReceptionTest, RefusalsAreLimitedAndWelcomesAreNot) {
  int refused = 0;
  for (int i = 0; i < 5000; ++i) {
    (void)Say(protocol::Ping{i + 1});
    refused += reception.reply().empty() ? 0 : 1;
  }
  EXPECT_EQ(refused, 2000);
  EXPECT_FALSE(Say(protocol::Hello{"newcomer", 0}));
  EXPECT_TRUE(Reply<protocol::Welcome>().has_value());
}

TEST_F(ReceptionTest, ALackOfPlacesIsSaid) {
  (void)Say(protocol::Hello{"test", 0});
  (void)Say(protocol::Hello{"test", Reply<protocol::Welcome>()->token});
  reception.RefuseForLimit(sent);
  const auto error = Reply<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->code, protocol::ErrorCode::kLimit);
}

TEST_F(ReceptionTest, APingIsLongEnoughForTheCodeOfTheError) {
  EXPECT_FALSE(Say(protocol::Ping{5}));
  const auto error = Reply<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value()) << "a client would not learn that the daemon has restarted";
  EXPECT_EQ(error->code, protocol::ErrorCode::kUnprovenAddress);
}

TEST_F(ReceptionTest, AFragmentIsAnsweredAsItsMessage) {
  std::vector<std::uint8_t> message;
  protocol::SkeletonOffer offer;
  offer.subject = "ann";
  for (int i = 0; i < 500; ++i) offer.blend_shape_names.push_back("shape" + std::to_string(i));
  encoder.Encode({.session = 77, .stream = 3}, offer, message);
  std::vector<std::uint8_t> datagram(protocol::kMaxDatagramBytes);
  ASSERT_GT(protocol::NumDatagrams(message.size()), 1u);
  datagram.resize(protocol::WriteDatagram(message, 1, 1, datagram));
  EXPECT_FALSE(reception.Admits(address, false, datagram, kReceptionNow));
  EXPECT_EQ(Reply<protocol::ErrorMessage>()->code, protocol::ErrorCode::kUnprovenAddress);
}

TEST_F(ReceptionTest, ShortAndBrokenMessagesGetNothing) {
  encoder.Encode({.session = 77}, protocol::Hello{"test", 0}, sent);
  for (std::size_t size = protocol::kEnvelopeBytes; size < sent.size(); ++size) {
    (void)reception.Admits(address, false, std::span(sent).first(size), kReceptionNow);
    EXPECT_LE(reception.reply().size(), size);
  }
  std::vector<std::uint8_t> broken = sent;
  for (std::size_t i = protocol::kEnvelopeBytes; i < 60; ++i) {
    broken[i] ^= 0xFF;
    EXPECT_FALSE(reception.Admits(address, false, broken, kReceptionNow)) << i;
    EXPECT_LE(reception.reply().size(), broken.size());
  }
}

class StrictReceptionTest : public ReceptionTest {
 protected:
  StrictReceptionTest() : ReceptionTest(/*requires_token=*/true) {}
};

TEST_F(StrictReceptionTest, NobodyComesInWithoutAToken) {
  EXPECT_FALSE(Say(protocol::Hello{"test", 0}));
  const auto error = Reply<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->code, protocol::ErrorCode::kNeedsToken);
  EXPECT_FALSE(error->message.empty());
  EXPECT_FALSE(Say(protocol::Hello{"test", proof.Token(address, 77, kReceptionNow)}))
      << "proves nothing";
  EXPECT_FALSE(Say(protocol::Ping{1}));
  EXPECT_EQ(Reply<protocol::ErrorMessage>()->code, protocol::ErrorCode::kNeedsToken);
  EXPECT_FALSE(Say(protocol::Welcome{"a daemon", 0}));
  EXPECT_TRUE(reception.reply().empty()) << "answers are never answered";
  for (int i = 0; i < 5000; ++i) Say(protocol::Ping{1});
  EXPECT_TRUE(reception.reply().empty()) << "not to a flood";
  EXPECT_EQ(metrics.Get(Counter::kRefusedNoToken), 5004u);
}

}  // namespace
}  // namespace furrow::server
