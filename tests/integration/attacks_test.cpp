// SPDX-License-Identifier: Apache-2.0
// Attacks on a running daemon over real sockets: forged datagrams, take-overs and floods. Forged
// means: from the address of the victim, with whatever an attacker can know.
#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "protocol/codec/codec.h"
#include "tests/integration/daemon_fixture.h"
#include "tests/integration/raw_client.h"

namespace furrow::testing_net {
namespace {

using server::Counter;

class Attacks : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(daemon.serves());
    sender.session = 0xA11CE;
    Offer(sender, offer);
    ASSERT_TRUE(viewer.Prove());
    ASSERT_TRUE(Watch(viewer, {.subject = "ann"}).has_value());
    ExpectWeights();
  }
  // The stream is alive: the next pose of the real sender reaches the viewer.
  void ExpectWeights() {
    sender.Send(PoseOf(clip, static_cast<int>(frame), offer), 1, frame, 16'667 * frame);
    protocol::Header header;
    ASSERT_TRUE(viewer.Await<protocol::WeightFrame>(&header).has_value());
    ASSERT_EQ(header.sequence, frame);
    ++frame;
  }
  // Sends a message from the socket of `victim`, so with its address, but with another session.
  template <class Message>
  static void Forge(UdpClient& victim, const Message& message, std::uint16_t stream,
                    std::uint32_t sequence = 0) {
    const std::uint64_t session = victim.session;
    victim.session = session + 1;
    victim.Send(message, stream, sequence);
    victim.session = session;
  }

  static server::Config ConfigOf() {
    server::Config config = WeightsConfig("arkit.json");
    config.limits.max_udp_peers = 32;   // fewer than the flood has addresses
    config.limits.loss_seconds = 1000;  // a slow machine must not give the subject away
    return config;
  }

  DaemonThread daemon{ConfigOf()};
  const motion::Clip clip = ArkitClip(200);
  const protocol::SkeletonOffer offer = OfferOf(clip, "ann");
  UdpClient sender{daemon.ready().udp};
  UdpClient viewer{daemon.ready().udp};
  std::uint32_t frame = 0;
};

TEST_F(Attacks, AForgedOfferTakesNothing) {
  Forge(sender, offer, 1);
  ExpectWeights();
  // From an address that was never proven.
  UdpClient forged(daemon.ready().udp, "127.0.0.2");
  forged.Send(offer, 1);
  EXPECT_EQ(forged.Await<protocol::ErrorMessage>()->code, protocol::ErrorCode::kUnprovenAddress);
  ExpectWeights();
  EXPECT_EQ(daemon.Count(Counter::kSubjectsRestarted), 0u);
}

TEST_F(Attacks, AnotherSenderDoesNotTakeALiveSubject) {
  UdpClient other(daemon.ready().udp, "127.0.0.2");
  ASSERT_TRUE(other.Prove());
  other.Send(offer, 1);
  const auto answer = other.Next();
  ASSERT_TRUE(answer.has_value());
  protocol::ErrorMessage error;
  ASSERT_EQ(protocol::Decode(answer->view, error), protocol::DecodeStatus::kOk)
      << "it has taken the subject over";
  EXPECT_EQ(error.code, protocol::ErrorCode::kSubjectTaken);
  other.Send(PoseOf(clip, 3, offer), 1, 1000);
  ExpectWeights();
  EXPECT_EQ(daemon.Count(Counter::kSubjectsRestarted), 0u);
}

TEST_F(Attacks, ForgedCommandsHaveNoEffect) {
  Forge(sender, protocol::Goodbye{}, 1);
  Forge(sender, PoseOf(clip, 3, offer), 1, 1'000'000);  // far ahead: later poses would be late
  Forge(viewer, protocol::Unsubscribe{}, 1);
  Forge(viewer, protocol::Goodbye{}, 0);
  Forge(viewer, protocol::Hello{"forged", 0}, 0);
  for (int i = 0; i < 5; ++i) ExpectWeights();
  EXPECT_EQ(daemon.Count(Counter::kPosesLate), 0u);
  for (const UdpClient* victim : {&sender, &viewer}) {
    for (const Received& message : victim->skipped) {
      EXPECT_NE(message.view.kind, protocol::MessageKind::kError) << "it would start over";
    }
  }
  EXPECT_GE(daemon.Count(Counter::kDatagramsUnproven), 4u);
}

TEST_F(Attacks, AFloodOfHellosAndPingsShutsNobodyOut) {
  std::deque<UdpClient> flood;
  for (int i = 0; i < 10; ++i) {
    for (int k = 0; k < 8; ++k) {
      UdpClient& forged = flood.emplace_back(daemon.ready().udp, "127.0.0.2");
      forged.Send(protocol::Hello{"flood", 1});
      forged.Send(protocol::Ping{});
    }
    const std::string host = "127.0.1." + std::to_string(i + 1);
    UdpClient newcomer(daemon.ready().udp, host.c_str());
    ASSERT_TRUE(newcomer.Prove()) << i;
    ASSERT_TRUE(Watch(newcomer, {.subject = "ann"}).has_value()) << i;
  }
  ExpectWeights();
}

TEST_F(Attacks, OneHostDoesNotTakeAllPlaces) {
  std::deque<UdpClient> greedy;
  bool refused = false;
  for (int i = 0; i < 32 && !refused; ++i) {
    UdpClient& peer = greedy.emplace_back(daemon.ready().udp, "127.0.0.2");
    peer.Send(protocol::Hello{"greedy", 0});
    const auto welcome = peer.Await<protocol::Welcome>();
    ASSERT_TRUE(welcome.has_value());
    peer.Send(protocol::Hello{"greedy", welcome->token});
    const auto answer = peer.Next();
    ASSERT_TRUE(answer.has_value());
    refused = answer->view.kind == protocol::MessageKind::kError;
  }
  EXPECT_TRUE(refused);
  UdpClient newcomer(daemon.ready().udp, "127.0.0.3");
  EXPECT_TRUE(newcomer.Prove());
  ExpectWeights();
}

TEST_F(Attacks, AnUnprovenAddressGetsNoMoreBytesThanItSent) {
  UdpClient forged(daemon.ready().udp, "127.0.0.2");
  std::vector<std::uint8_t> bytes;
  protocol::Encoder encoder;
  const auto exchange = [&](const auto& message) {
    encoder.Encode({.session = forged.session}, message, bytes);
    forged.SendRaw(bytes);
    const auto reply = forged.Next();
    ASSERT_TRUE(reply.has_value());
    EXPECT_LE(reply->bytes.size(), bytes.size());
  };
  exchange(protocol::Hello{"forged", 0});
  exchange(protocol::SubscribeWeights{.subject = "ann"});
  exchange(protocol::Ping{1});
  exchange(PoseOf(clip, 0, offer));
}

}  // namespace
}  // namespace furrow::testing_net
