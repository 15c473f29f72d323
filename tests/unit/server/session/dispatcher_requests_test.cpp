// SPDX-License-Identifier: Apache-2.0
// What a peer may ask for per second, and what requests for nothing cost.
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using protocol::ErrorCode;

class DispatcherRequests : public HubPeersTest {
 protected:
  // Sends the request `count` times at once. Returns how many were answered as usual.
  int Flood(FakePeer& peer, const protocol::SubscribeWeights& request, int count) {
    int answered = 0;
    for (int i = 0; i < count; ++i) {
      Send(peer, request, 0, ++sequence_);
      if (peer.inbox.empty()) continue;
      protocol::MessageView view;
      protocol::ErrorMessage error;
      (void)protocol::OpenMessage(peer.inbox.front(), view, protocol::kMaxReplyBytes);
      const bool is_error = protocol::Decode(view, error) == protocol::DecodeStatus::kOk;
      if (!is_error || error.message.find("too many requests") == std::string::npos) ++answered;
      peer.inbox.clear();
    }
    return answered;
  }
  std::uint32_t sequence_ = 0;
};

TEST_F(DispatcherRequests, AFloodOfRequestsIsRefused) {
  const protocol::SubscribeWeights unknown{.subject = "nobody"};
  EXPECT_LT(Flood(viewer, unknown, 3'500), 2'500);
  EXPECT_GT(Count(Counter::kRequestsThrottled), 1'000u);
  EXPECT_EQ(Flood(sender, unknown, 10), 10) << "another peer";
  Advance(1);
  EXPECT_GT(Flood(viewer, unknown, 1'000), 100) << "later";
  // A UDP client repeats what is not answered.
  FakePeer udp;
  Connect(&udp, Transport::kUdp);
  for (int i = 0; i < 3'500; ++i) Send(udp, protocol::Hello{});
  const std::uint64_t before = udp.bytes_received;
  Send(udp, protocol::Hello{});
  EXPECT_EQ(udp.bytes_received, before);
}

TEST_F(DispatcherRequests, LongPatternsCostMore) {
  Publish(sender, "ann");
  std::string pattern;
  while (pattern.size() < 4'000) pattern += "?a,";
  const int answered = Flood(viewer, {.subject = "ann", .pattern = pattern}, 1'000);
  EXPECT_GE(answered, 10);
  EXPECT_LT(answered, 50);
}

TEST_F(DispatcherRequests, PosesAreNotRequests) {
  Publish(sender, "ann");
  for (std::uint32_t i = 1; i <= 3'000; ++i) Send(sender, Pose(0.5f), 1, i);
  EXPECT_EQ(Count(Counter::kRequestsThrottled), 0u);
}

// An offer that is repeated changes nothing, and still stops the other threads.
TEST_F(DispatcherRequests, OffersHaveABudgetOfTheirOwn) {
  Limits limits;
  limits.packet_burst = 20'000;
  Make(limits);
  Connect(&sender);
  for (int i = 0; i < 4'000; ++i) Send(sender, Offer("ann"), 1);
  EXPECT_EQ(Count(Counter::kRequestsThrottled), 0u);
  for (int i = 0; i < 2'000; ++i) Send(sender, Offer("ann"), 1);
  EXPECT_GT(Count(Counter::kRequestsThrottled), 1'000u);
  sender.inbox.clear();
  EXPECT_EQ(Flood(sender, {.subject = "nobody"}, 100), 100) << "other requests";
}

// Another thread holds its shard: a request that needed the exclusive lock would wait for it.
TEST_F(DispatcherRequests, EndingNothingStopsNoOtherThread) {
  MakeWith(MakeRig(false), {}, /*shards=*/2);
  Connect(&viewer);  // of shard 0
  const Hub::ShardLock other(*hub, 1);
  std::thread([this] { Send(viewer, protocol::Unsubscribe{}, 7); }).join();
  EXPECT_TRUE(viewer.inbox.empty());
}

TEST_F(DispatcherRequests, AStateOfOthersThanOperatorsStopsNoOtherThread) {
  MakeWith(MakeRig(false), {}, /*shards=*/2);
  Connect(&viewer);  // of shard 0
  const protocol::secure::Grant grant{.roles = protocol::secure::Role::kPublish};
  hub->SetAccess(viewer.id, Access::Of(grant, 1, now + FromSeconds(60)));
  const Hub::ShardLock other(*hub, 1);
  std::thread([this] { Send(viewer, protocol::SubjectState{.subject = "ann"}, 0); }).join();
  ExpectError(viewer, protocol::ErrorCode::kNotPermitted);
}

TEST_F(DispatcherRequests, StatesAreRequests) {
  for (int i = 0; i < 3'000; ++i) Send(viewer, protocol::SubjectState{.subject = "ann"}, 0);
  EXPECT_GT(Count(Counter::kRequestsThrottled), 0u);
}

}  // namespace
}  // namespace furrow::server
