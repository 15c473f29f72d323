// SPDX-License-Identifier: Apache-2.0
// Solving poses in batches does not change the output.
#include <array>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint16_t kStreams = 6;   // per peer; the last one is never offered
constexpr std::uint64_t kRandom = 900;  // every "random" number

// Logs events as text, except datagrams, which do not pass the hub.
class WordyTap : public RecordingTap {
 public:
  void OnOffer(const Subject& subject, const protocol::SkeletonOffer&, Time) override {
    Tell("offer", subject, 0);
  }
  void OnPose(const Subject& subject, std::span<const std::uint8_t> payload, Time) override {
    Tell("pose", subject, static_cast<double>(subject.pipeline->sequence()));
    payloads.emplace_back(payload.begin(), payload.end());
  }
  void OnWeights(const Subject& subject, std::int64_t, Time) override {
    for (const float weight : subject.pipeline->wrinkle_weights()) Tell("weight", subject, weight);
  }
  void OnSubjectGone(const Subject& subject) override { Tell("gone", subject, 0); }
  void OnDatagram(const std::array<std::uint8_t, 18>&, std::span<const std::uint8_t>,
                  Time) override {}
  void OnRig(const wrinkle::Rig&, const SubjectRegistry&, Time) override {}

  std::vector<std::string> told;
  std::vector<Bytes> payloads;

 private:
  void Tell(const char* what, const Subject& subject, double number) {
    told.push_back(what + (" " + subject.name) + " " + std::to_string(number));
  }
};

// A hub with two peers that publish and subscribe, one over TCP and one over UDP.
struct World {
  explicit World(wrinkle::Rig rig) {
    Hub::Parts parts;
    parts.session = 4242;
    parts.rig = std::make_shared<const wrinkle::Rig>(std::move(rig));
    parts.metrics = &metrics;
    parts.random = [] { return std::uint64_t{kRandom}; };
    parts.recording = &tap;
    hub = std::make_unique<Hub>(std::move(parts));
    hub->SetOnWeights([this](const Subject& subject, int, Time) { heard.push_back(subject.name); });
    peers[0].id = hub->AddPeer(Transport::kUdp, "udp", &peers[0], FromSeconds(1000));
    peers[1].id = hub->AddPeer(Transport::kTcp, "tcp", &peers[1], FromSeconds(1000));
  }

  Metrics metrics;
  WordyTap tap;
  std::vector<std::string> heard;
  std::array<FakePeer, 2> peers;
  std::unique_ptr<Hub> hub;
};

class StreamRouterTest : public HubTest {
 protected:
  struct Piece {
    std::size_t peer = 0;
    Bytes bytes;
  };

  template <class Message>
  Piece Make(std::size_t peer, const Message& message, protocol::Header header) {
    header.session = 70 + peer;
    Piece piece{peer, {}};
    encoder.Encode(header, message, piece.bytes);
    return piece;
  }
  unsigned Random(unsigned below) {
    return std::uniform_int_distribution<unsigned>(0, below - 1)(random);
  }
  static std::string NameOf(std::size_t peer, std::uint16_t stream) {
    return "subject " + std::to_string(peer) + std::to_string(stream);
  }

  // The offers and subscriptions of both peers.
  std::vector<Piece> Opening() {
    std::vector<Piece> script{Make(0, protocol::Hello{"test", 900}, {})};
    for (std::size_t peer = 0; peer < 2; ++peer) {
      for (std::uint16_t stream = 1; stream < kStreams; ++stream) {
        script.push_back(Make(peer, Offer(NameOf(peer, stream)), {.stream = stream}));
        const auto request = static_cast<std::uint32_t>(10 * stream);
        script.push_back(Make(1 - peer, protocol::SubscribeWeights{.subject = NameOf(peer, stream)},
                              {.sequence = request}));
        script.push_back(Make(1 - peer, protocol::SubscribePoses{.subject = NameOf(peer, stream)},
                              {.sequence = request + 1}));
      }
    }
    return script;
  }
  // A pose: mostly the next one of its stream, else late, duplicate, partial, or of an unknown
  // stream or skeleton.
  Piece AnyPose(std::size_t peer) {
    const auto stream = static_cast<std::uint16_t>(1 + Random(kStreams));
    std::uint32_t& next = next_sequence[peer][stream];
    next += Random(8) == 0 ? 0 : 1;
    protocol::PoseFrame pose = Pose(static_cast<float>(Random(100)) * 0.01f, 0.5f);
    if (Random(8) == 0) {
      pose.partial = true;
      pose.blend_shape_indices = {1};
      pose.blend_shapes = {0.75f};
    }
    if (Random(40) == 0) ++pose.skeleton_hash;
    const std::uint32_t sequence = Random(10) == 0 ? next / 2 : next;
    return Make(peer, pose,
                {.stream = stream, .sequence = sequence, .capture_time_us = 16'667 * sequence});
  }
  Piece Anything() {
    const std::size_t peer = Random(2);
    switch (Random(40)) {
      case 0: return Make(peer, protocol::Ping{5}, {.sequence = 7});
      case 1: return {peer, Bytes(40, 0x5A)};
      case 2: {
        Piece broken = AnyPose(peer);
        std::ranges::fill(std::span(broken.bytes).subspan(40), 0xFF);
        return broken;
      }
      case 3:
        return Make(peer, protocol::Unsubscribe{},
                    {.stream = static_cast<std::uint16_t>(Random(9))});
      case 4:
        return Make(peer, protocol::SubscribeWeights{.subject = NameOf(1 - peer, 2)},
                    {.sequence = 1000 + Random(1000)});
      case 5: return Make(peer, Offer(NameOf(Random(2), 3)), {.stream = 3});
      case 6: {
        const auto stream = static_cast<std::uint16_t>(1 + Random(kStreams - 1));
        return Make(peer, protocol::Goodbye{}, {.stream = stream});
      }
      case 7: return Make(peer, protocol::Pong{kRandom >> 2, 0}, {});  // answers any challenge
      default: return AnyPose(peer);
    }
  }

  std::mt19937 random{1};
  std::uint32_t next_sequence[2][kStreams + 1] = {};
};

void ExpectSame(const World& one, const World& other) {
  for (std::size_t peer = 0; peer < one.peers.size(); ++peer) {
    EXPECT_EQ(one.peers[peer].inbox, other.peers[peer].inbox) << "peer " << peer;
  }
  EXPECT_EQ(one.tap.told, other.tap.told);
  EXPECT_EQ(one.tap.payloads, other.tap.payloads);
  EXPECT_EQ(one.heard, other.heard);
  for (std::size_t i = 0; i < static_cast<std::size_t>(Counter::kCount); ++i) {
    const auto counter = static_cast<Counter>(i);
    EXPECT_EQ(one.metrics.Get(counter), other.metrics.Get(counter)) << "counter " << i;
  }
}

TEST_F(StreamRouterTest, BatchedPosesProduceTheSameOutputAsSinglePoses) {
  World one(MakeRig(/*filter=*/true));
  World many(MakeRig(/*filter=*/true));
  std::vector<Piece> script = Opening();
  while (script.size() < 6000) script.push_back(Anything());
  for (std::size_t at = 0; at < script.size();) {
    const std::size_t end = std::min(script.size(), at + 1 + Random(200));
    Advance(0.01);
    {
      const Hub::ShardLock turn(*many.hub, 0);
      for (; at < end; ++at) {
        const auto& [peer, bytes] = script[at];
        one.hub->OnMessage(one.peers[peer].id, bytes, now);
        many.hub->GatherMessage(many.peers[peer].id, bytes, now);
      }
    }
    one.hub->Tick(now);
    many.hub->Tick(now);
  }
  EXPECT_GT(one.metrics.Get(Counter::kWeightsSent), 1000u);
  EXPECT_GT(one.metrics.Get(Counter::kPosesDuplicate), 10u);
  EXPECT_GT(one.metrics.Get(Counter::kPosesLate), 10u);
  EXPECT_GT(one.metrics.Get(Counter::kPosesUnknownStream), 10u);
  ExpectSame(one, many);
}

// Also if the peer is evicted to make room for another.
TEST_F(StreamRouterTest, RemovingAPeerPublishesWaitingPosesFirst) {
  World world(MakeRig(/*filter=*/false));
  for (const auto& [peer, bytes] : Opening()) {
    world.hub->OnMessage(world.peers[peer].id, bytes, now);
  }
  world.peers[1].inbox.clear();
  const Piece pose = Make(0, Pose(0.5f), {.stream = 1});
  const Hub::ShardLock turn(*world.hub, 0);
  world.hub->GatherMessage(world.peers[0].id, pose.bytes, now);
  EXPECT_TRUE(world.peers[1].inbox.empty());
  world.hub->RemovePeer(world.peers[1].id);
  EXPECT_TRUE(world.peers[1].Take<protocol::WeightFrame>().has_value());
}

}  // namespace
}  // namespace furrow::server
