// SPDX-License-Identifier: Apache-2.0
// A hub that several threads share, each with its shard.
#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/server/session/fake_cluster.h"
#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

constexpr int kHubShards = 3;

// Collects frames from several threads, by subscription and in order.
class SharedPeer : public Link {
 public:
  void SendReply(std::span<const std::uint8_t>) override {}
  int SendFrame(std::uint64_t, std::span<const std::uint8_t> message, std::size_t,
                int shard) override {
    protocol::MessageView view;
    EXPECT_EQ(protocol::OpenMessage(message, view), protocol::DecodeStatus::kOk);
    const std::lock_guard lock(mutex_);
    sequences[view.header.stream].push_back(view.header.sequence);
    ++by_shard[shard];
    return 0;
  }
  void DropFrames(std::uint64_t) override {}

  std::map<std::uint16_t, std::vector<std::uint32_t>> sequences;
  std::map<int, int> by_shard;

 private:
  std::mutex mutex_;
};

class CountingSender : public BufferedSender {
 public:
  void Flush() override { ++flushes; }
  int flushes = 0;
};

class ShardsTest : public HubTest {
 protected:
  void SetUp() override {
    Limits limits;
    limits.packets_per_second = 1e9;
    limits.packet_burst = 1e9;
    MakeWith(MakeRig(/*filter=*/false), limits, kHubShards);
  }
  void ConnectIn(int shard, FakePeer* peer, Transport transport = Transport::kTcp) {
    peer->id = hub->AddPeer(transport, "fake", peer, now, shard);
  }
};

TEST_F(ShardsTest, PeerIdsAreUniqueAcrossShards) {
  FakePeer peers[2 * kHubShards];
  std::map<PeerId, int> seen;
  for (int i = 0; i < 2 * kHubShards; ++i) {
    ConnectIn(i % kHubShards, &peers[i]);
    EXPECT_NE(peers[i].id, 0u);
    EXPECT_EQ(PeerTable::TableOf(peers[i].id, kHubShards),
              static_cast<std::size_t>(i % kHubShards));
    EXPECT_EQ(++seen[peers[i].id], 1);
  }
}

TEST_F(ShardsTest, SubscribersReceivePosesFromOtherShards) {
  FakePeer sender;
  FakePeer viewer;
  ConnectIn(2, &sender);
  ConnectIn(1, &viewer);
  Publish(sender, "ada");
  EXPECT_NE(Watch(viewer, {.subject = "ada"}), 0);
  Send(sender, Pose(0.5f, 0.25f), 1, 1);
  const auto weights = viewer.Take<protocol::WeightFrame>();
  ASSERT_TRUE(weights.has_value());
  EXPECT_EQ(weights->message.values, (std::vector<float>{0.5f, 0.25f}));
}

TEST_F(ShardsTest, ASenderOfAnotherShardTakesOverASubject) {
  FakePeer first;
  FakePeer second;
  FakePeer viewer;
  ConnectIn(0, &first);
  ConnectIn(1, &second);
  ConnectIn(2, &viewer);
  second.session = 78;
  Publish(first, "ada");
  EXPECT_NE(Watch(viewer, {.subject = "ada"}), 0);
  Send(first, Pose(0.5f), 1, 1);
  ASSERT_TRUE(viewer.Take<protocol::WeightFrame>().has_value());
  Advance(0.6);
  Publish(second, "ada");
  Send(second, Pose(0.75f), 1, 1);
  const auto weights = viewer.Take<protocol::WeightFrame>();
  ASSERT_TRUE(weights.has_value());
  EXPECT_EQ(weights->message.values[0], 0.75f);
  Send(first, Pose(0.25f), 1, 2);
  const auto reply = first.Take<protocol::SkeletonReply>();
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->message.status, protocol::SkeletonStatus::kNeeded);
  EXPECT_TRUE(viewer.inbox.empty());
  EXPECT_EQ(hub->num_subjects(), 1u);
}

TEST_F(ShardsTest, ARemovedSenderIsForgottenInAnyShard) {
  FakePeer sender;
  ConnectIn(2, &sender);
  Publish(sender, "ada");
  EXPECT_EQ(hub->SourceOf(*hub->RequireAllDrivers("ada")), "fake");
  hub->RemovePeer(sender.id);
  EXPECT_EQ(hub->SourceOf(*hub->RequireAllDrivers("ada")), "");
}

TEST_F(ShardsTest, GoodbyesReachAllShards) {
  FakePeer peers[kHubShards];
  for (int shard = 0; shard < kHubShards; ++shard) ConnectIn(shard, &peers[shard]);
  hub->Drain(Time{0});
  for (FakePeer& peer : peers) EXPECT_TRUE(peer.Take<protocol::Goodbye>().has_value());
}

// The redirect takes the way of the replies, so the last frames must, too.
TEST_F(ShardsTest, HeldPosesOfAnotherShardLeaveBeforeTheRedirect) {
  FakeCluster nodes;
  nodes.places["ada"] = FakeCluster::Here(now + FromSeconds(60.0), 1);
  cluster = &nodes;
  jitter = {{"*", 50.0}};
  MakeWith(MakeRig(/*filter=*/false), {}, kHubShards);
  FakePeer sender;
  SharedPeer viewer;
  ConnectIn(1, &sender);
  const PeerId watching = hub->AddPeer(Transport::kTcp, "viewer", &viewer, now, 2);
  Publish(sender, "ada");
  std::vector<std::uint8_t> request;
  encoder.Encode({.session = 5, .sequence = 1}, protocol::SubscribeWeights{.subject = "ada"},
                 request);
  hub->OnMessage(watching, request, now);
  ASSERT_EQ(hub->num_subscriptions(), 1u);
  Send(sender, Pose(0.5f), 1, 1, 1'000'000);
  EXPECT_TRUE(viewer.by_shard.empty()) << "held";
  std::vector<std::uint8_t> state;
  ASSERT_TRUE(hub->HandOver("ada", FakeCluster::kOther, 7, state, now).ok());
  EXPECT_EQ(viewer.by_shard, (std::map<int, int>{{Link::kExclusive, 1}}));
  hub.reset();
}

TEST_F(ShardsTest, BufferedMessagesLeaveBeforeALockIsReleased) {
  CountingSender buffered_senders[kHubShards];
  for (int shard = 0; shard < kHubShards; ++shard)
    hub->SetBufferedSender(shard, &buffered_senders[shard]);
  {
    const Hub::ShardLock turn(*hub, 1);
    const Hub::ShardLock inner(*hub, 1);
    EXPECT_EQ(buffered_senders[1].flushes, 0);
  }
  EXPECT_EQ(buffered_senders[1].flushes, 1);
  EXPECT_EQ(buffered_senders[0].flushes, 0);
  {
    const Hub::ShardLock turn(*hub, 1);
    const Hub::ExclusiveLock alone(*hub, 1);
    EXPECT_EQ(buffered_senders[1].flushes, 2)
        << "before another shard may publish the same subject";
    const Hub::ExclusiveLock inner(*hub, 1);
  }
  EXPECT_EQ(buffered_senders[0].flushes, 1) << "answers to peers of other shards";
  for (int shard = 0; shard < kHubShards; ++shard) hub->SetBufferedSender(shard, nullptr);
}

// One socket per shard. Its messages leave when the shard is flushed.
class Wire {
 public:
  class End : public Link {
   public:
    End(Wire* wire, int shard) : wire_(wire), shard_(static_cast<std::size_t>(shard)) {}
    void SendReply(std::span<const std::uint8_t> message) override { Add(shard_, message); }
    int SendFrame(std::uint64_t, std::span<const std::uint8_t> message, std::size_t,
                  int shard) override {
      Add(shard == kExclusive ? shard_ : static_cast<std::size_t>(shard), message);
      return 0;
    }
    void DropFrames(std::uint64_t) override {}

   private:
    void Add(std::size_t shard, std::span<const std::uint8_t> message) {
      protocol::MessageView view;
      EXPECT_EQ(protocol::OpenMessage(message, view, protocol::kMaxReplyBytes),
                protocol::DecodeStatus::kOk);
      wire_->sockets[shard].waiting.push_back(view.kind);
    }
    Wire* wire_;
    std::size_t shard_;
  };
  struct Socket : BufferedSender {
    void Flush() override {
      wire->left.insert(wire->left.end(), waiting.begin(), waiting.end());
      waiting.clear();
    }
    Wire* wire = nullptr;
    std::vector<protocol::MessageKind> waiting;
  };

  Wire() {
    for (Socket& socket : sockets) socket.wire = this;
  }
  Socket sockets[kHubShards];
  std::vector<protocol::MessageKind> left;
};

TEST_F(ShardsTest, WeightsNeverOvertakeTheirNames) {
  FakePeer sender;
  ConnectIn(0, &sender);
  Publish(sender, "ada");
  Send(sender, Pose(0.5f), 1, 1);
  Wire wire;
  for (int shard = 0; shard < kHubShards; ++shard)
    hub->SetBufferedSender(shard, &wire.sockets[shard]);
  Wire::End viewer(&wire, 2);
  const PeerId id = hub->AddPeer(Transport::kTcp, "viewer", &viewer, now, 2);
  std::vector<std::uint8_t> bytes;
  encoder.Encode({99, 0, 1, 0}, protocol::SubscribeWeights{.subject = "ada"}, bytes);
  hub->OnMessage(id, bytes, now);
  hub->Tick(now);
  wire.left.clear();
  wrinkle::Rig rig = MakeRig(/*filter=*/false);
  rig.regions.front().name = "forehead";
  {
    const Hub::ExclusiveLock alone(*hub, 0);
    ASSERT_TRUE(hub->SetRig(std::make_shared<const wrinkle::Rig>(std::move(rig)), now).ok());
  }
  using protocol::MessageKind;
  EXPECT_EQ(wire.left, (std::vector{MessageKind::kSubscribeReply, MessageKind::kWeights}));
  for (int shard = 0; shard < kHubShards; ++shard) hub->SetBufferedSender(shard, nullptr);
}

TEST_F(ShardsTest, ShardsPublishAtOnceWhileTheSessionChanges) {
  constexpr int kSubjects = 4;  // per shard
  constexpr std::uint32_t kPoses = 300;
  SharedPeer watcher;
  const PeerId watcher_id = hub->AddPeer(Transport::kTcp, "watcher", &watcher, now, 0);
  std::map<int, std::unique_ptr<FakePeer>> senders;  // by shard; this thread owns shard 0
  for (int shard = 1; shard < kHubShards; ++shard) {
    senders[shard] = std::make_unique<FakePeer>();
    ConnectIn(shard, senders[shard].get());
    for (std::uint16_t i = 0; i < kSubjects; ++i) {
      const std::string name = std::to_string(shard) + "/" + std::to_string(i);
      Publish(*senders[shard], name, i);
      std::vector<std::uint8_t> bytes;
      encoder.Encode({99, 0, static_cast<std::uint32_t>(shard * kSubjects + i), 0},
                     protocol::SubscribeWeights{.subject = name}, bytes);
      hub->OnMessage(watcher_id, bytes, now);
    }
  }
  std::vector<std::jthread> threads;
  for (int shard = 1; shard < kHubShards; ++shard) {
    threads.emplace_back([&, shard, id = senders[shard]->id] {
      protocol::Encoder own;
      std::vector<std::uint8_t> batch[kSubjects];
      for (std::uint32_t pose = 0; pose < kPoses; ++pose) {
        const Hub::ShardLock turn(*hub, shard);
        for (std::uint16_t i = 0; i < kSubjects; ++i) {
          own.Encode({77, i, pose, 1 + pose}, Pose(0.5f), batch[i]);
          hub->GatherMessage(id, batch[i], now);
        }
      }
    });
  }
  for (int i = 0; i < 100; ++i) {
    hub->Tick(now);
    FakePeer passer_by;
    ConnectIn(0, &passer_by);
    EXPECT_NE(Watch(passer_by, {.subject = "nobody", .wait = true}), 0);
    hub->RemovePeer(passer_by.id);
  }
  threads.clear();
  constexpr int kAll = (kHubShards - 1) * kSubjects;
  EXPECT_EQ(Count(Counter::kPosesReceived), std::uint64_t{kAll * kPoses});
  EXPECT_EQ(watcher.sequences.size(), std::size_t{kAll});
  for (const auto& [subscription, sequences] : watcher.sequences) {
    EXPECT_TRUE(std::ranges::is_sorted(sequences)) << subscription;
    EXPECT_GE(sequences.size(), kPoses) << subscription;
    EXPECT_EQ(sequences.back(), kPoses - 1) << subscription;
  }
  for (int shard = 1; shard < kHubShards; ++shard) EXPECT_GT(watcher.by_shard[shard], 0) << shard;
}

}  // namespace
}  // namespace furrow::server
