// SPDX-License-Identifier: Apache-2.0
// Subscriptions: patterns, rates, waiting, proof of address, limits.
#include <list>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/session/subscriptions/subscription_table.h"
#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using protocol::ErrorCode;
using testing::ElementsAre;
using testing::FloatEq;
using testing::HasSubstr;

class SubscribersTest : public HubPeersTest {};

TEST_F(SubscribersTest, APatternSelectsNamesInTheOrderOfTheRig) {
  Publish(sender, "ann");
  Send(viewer, protocol::SubscribeWeights{.subject = "ann", .pattern = "no*, nothing"}, 0, 8);
  const auto reply = viewer.Take<protocol::SubscribeReply>();
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->header.sequence, 8u);
  EXPECT_EQ(reply->message.subject, "ann");
  EXPECT_THAT(reply->message.names, ElementsAre("nose.squash"));
  Send(sender, Pose(0.1f, 0.9f), 1, 0);
  const auto frame = viewer.Take<protocol::WeightFrame>();
  EXPECT_EQ(frame->message.names_hash, reply->message.names_hash);
  EXPECT_THAT(frame->message.values, ElementsAre(FloatEq(0.9f)));
}

TEST_F(SubscribersTest, U8IsWithinHalfAStepAndDriverValuesHaveOwnNames) {
  Publish(sender, "ann");
  Send(viewer,
       protocol::SubscribeWeights{.format = protocol::WeightFormat::kU8,
                                  .source = protocol::WeightSource::kDriverValues},
       0, 1);
  EXPECT_THAT(viewer.Take<protocol::SubscribeReply>()->message.names,
              ElementsAre("brow.value", "nose.value"));
  Send(sender, Pose(0.123f, 0.777f), 1, 0);
  const auto frame = viewer.Take<protocol::WeightFrame>();
  EXPECT_EQ(frame->message.format, protocol::WeightFormat::kU8);
  EXPECT_NEAR(frame->message.values[0], 0.123f, 1.0f / 510.0f + 1e-6f);
  EXPECT_NEAR(frame->message.values[1], 0.777f, 1.0f / 510.0f + 1e-6f);
}

TEST_F(SubscribersTest, APatternWithoutMatchesIsAnError) {
  Publish(sender, "ann");
  Send(viewer, protocol::SubscribeWeights{.pattern = "elbow*"});
  ExpectError(viewer, ErrorCode::kNoMatch);
  EXPECT_EQ(hub->num_subscriptions(), 0u);
}

TEST_F(SubscribersTest, AnUnknownSubjectIsAnErrorThatListsSubjects) {
  Publish(sender, "ann");
  Send(viewer, protocol::SubscribeWeights{.subject = "eve"}, 0, 31);
  const auto error = viewer.Take<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->message.code, ErrorCode::kUnknownSubject);
  EXPECT_EQ(error->header.sequence, 31u);
  EXPECT_THAT(error->message.message, HasSubstr("ann"));
}

TEST_F(SubscribersTest, ARepeatedGoodbyeDoesNotEndASubscription) {
  const std::uint16_t id = Watch(sender, {.subject = "ann", .wait = true});
  Publish(sender, "ben", id);
  Send(sender, protocol::Goodbye{}, id);
  hub->Tick(now);
  Send(sender, protocol::Goodbye{}, id);  // the stream has ended
  EXPECT_EQ(hub->num_subscriptions(), 1u);
}

TEST_F(SubscribersTest, AWaitingSubscriptionBindsEachTimeItsSubjectAppears) {
  const std::uint16_t id = Watch(viewer, {.subject = "ann", .wait = true});
  ASSERT_NE(id, 0);
  Publish(sender, "ben", 2);
  EXPECT_TRUE(viewer.inbox.empty());
  Publish(sender, "ann", 1);
  auto reply = viewer.Take<protocol::SubscribeReply>();
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->header.stream, id);
  EXPECT_EQ(reply->message.subject, "ann");
  EXPECT_EQ(reply->message.names.size(), 2u);

  Send(sender, protocol::Goodbye{}, 1);
  hub->Tick(now);
  EXPECT_EQ(viewer.Take<protocol::Goodbye>()->message.reason,
            protocol::GoodbyeReason::kSubjectGone);
  EXPECT_EQ(hub->num_subscriptions(), 1u);
  Publish(sender, "ann", 1);
  reply = viewer.Take<protocol::SubscribeReply>();
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->header.stream, id);
}

TEST_F(SubscribersTest, AnUnnamedSubscriptionMovesToTheOldestSubject) {
  Publish(sender, "ann", 1);
  Publish(sender, "ben", 2);
  const std::uint16_t id = Watch(viewer, {.wait = true});
  Send(sender, protocol::Goodbye{}, 1);
  hub->Tick(now);
  EXPECT_TRUE(viewer.Take<protocol::Goodbye>().has_value());
  const auto reply = viewer.Take<protocol::SubscribeReply>();
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->header.stream, id);
  EXPECT_EQ(reply->message.subject, "ben");
  Send(sender, Pose(0.5f), 2);
  EXPECT_TRUE(viewer.Take<protocol::WeightFrame>().has_value());
}

TEST_F(SubscribersTest, NoNameSelectsTheOldestSubject) {
  Publish(sender, "zoe", 1);
  Publish(sender, "ann", 2);
  Send(viewer, protocol::SubscribeWeights{});
  EXPECT_EQ(viewer.Take<protocol::SubscribeReply>()->message.subject, "zoe");
}

TEST_F(SubscribersTest, ARepeatedRequestIsTheSameSubscription) {
  Publish(sender, "ann");
  const std::uint16_t first = Watch(viewer, {.subject = "ann"}, 5);
  const std::uint16_t again = Watch(viewer, {.subject = "ann"}, 5);
  const std::uint16_t other = Watch(viewer, {.subject = "ann"}, 6);
  EXPECT_EQ(first, again);
  EXPECT_NE(first, other);
  EXPECT_EQ(hub->num_subscriptions(), 2u);
}

TEST_F(SubscribersTest, ALateSubscriberReceivesTheNewestPose) {
  Publish(sender, "ann");
  Send(sender, Pose(0.5f), 1, 9);
  Watch(viewer, {.subject = "ann"});
  hub->Tick(now);
  const auto frame = viewer.Take<protocol::WeightFrame>();
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->header.sequence, 9u);
}

TEST_F(SubscribersTest, EachSubscriptionHasItsRateAndReceivesTheLastPose) {
  Publish(sender, "ann");
  FakePeer slow;
  Connect(&slow);
  Watch(viewer, {.subject = "ann"});
  Watch(slow, {.subject = "ann", .max_rate_hz = 10.0f});
  for (std::uint32_t i = 0; i < 60; ++i) {
    Send(sender, Pose(1), 1, i);
    Advance(1.0 / 60.0);
  }
  EXPECT_EQ(viewer.inbox.size(), 60u);
  EXPECT_NEAR(static_cast<double>(slow.inbox.size()), 10.0, 1.0);
  EXPECT_EQ(Count(Counter::kFramesSkippedRate), 60u - slow.inbox.size());
  Advance(0.1);
  hub->Tick(now);
  while (slow.inbox.size() > 1) slow.Take<protocol::WeightFrame>();
  EXPECT_EQ(slow.Take<protocol::WeightFrame>()->header.sequence, 59u);
}

TEST_F(SubscribersTest, UnsubscribingDropsQueuedFrames) {
  Publish(sender, "ann");
  const std::uint16_t id = Watch(viewer, {.subject = "ann"});
  Send(viewer, protocol::Unsubscribe{}, id);
  Send(sender, Pose(1), 1, 0);
  EXPECT_TRUE(viewer.inbox.empty());
  EXPECT_EQ(viewer.dropped_keys.size(), 1u);
  EXPECT_EQ(hub->num_subscriptions(), 0u);
}

TEST_F(SubscribersTest, RemovingAPeerEndsItsSubscriptions) {
  Publish(sender, "ann");
  Watch(viewer, {.subject = "ann"});
  hub->RemovePeer(viewer.id);
  Send(sender, Pose(1), 1, 0);
  EXPECT_EQ(hub->num_subscriptions(), 0u);
  EXPECT_TRUE(viewer.inbox.empty());
}

TEST_F(SubscribersTest, LimitsAreEnforced) {
  Limits limits;
  limits.max_subscriptions = 2;
  limits.packet_burst = 6;
  limits.packets_per_second = 1;
  Make(limits);
  Connect(&viewer);
  for (std::uint32_t i = 0; i < 2; ++i) EXPECT_NE(Watch(viewer, {.wait = true}, i), 0);
  Send(viewer, protocol::SubscribeWeights{.wait = true}, 0, 3);
  ExpectError(viewer, ErrorCode::kLimit);
  for (int i = 0; i < 10; ++i) Send(viewer, protocol::Ping{});
  EXPECT_EQ(viewer.inbox.size(), 3u);
  EXPECT_EQ(Count(Counter::kMessagesThrottled), 7u);
}

// A host may have many connections.
TEST_F(SubscribersTest, NoHostTakesAllSubscriptions) {
  Limits limits;
  limits.max_all_subscriptions = 300;
  Make(limits);
  const auto connect = [this](FakePeer* peer, const char* host) {
    peer->id = hub->AddPeer(Transport::kTcp, {"fake", host}, peer, now);
  };
  const auto watches = [this](FakePeer& peer, std::uint32_t sequence) {
    const std::size_t before = hub->num_subscriptions();
    Send(peer, protocol::SubscribeWeights{.wait = true}, 0, sequence);
    return hub->num_subscriptions() > before;
  };
  std::list<FakePeer> crowd;
  std::size_t taken = 0;
  bool is_refused = false;
  while (!is_refused && taken <= 300) {
    connect(&crowd.emplace_back(), "192.0.2.1");
    for (std::uint32_t i = 0; i < 64 && !is_refused; ++i) {
      is_refused = !watches(crowd.back(), i);
      if (!is_refused) ++taken;
    }
  }
  EXPECT_EQ(taken, 150u);
  auto& inbox = crowd.back().inbox;
  inbox.erase(inbox.begin(), inbox.end() - 1);
  const auto refusal = crowd.back().Take<protocol::ErrorMessage>();
  ASSERT_TRUE(refusal.has_value());
  EXPECT_EQ(refusal->message.code, ErrorCode::kLimit);
  EXPECT_EQ(refusal->message.message,
            "one host gets at most half of the 300 subscriptions; see "
            "limits.max_all_subscriptions");
  FakePeer newcomer;
  connect(&newcomer, "192.0.2.2");
  EXPECT_TRUE(watches(newcomer, 1));
  hub->RemovePeer(crowd.front().id);
  EXPECT_TRUE(watches(crowd.back(), 99)) << "there is room again";
  limits.max_all_subscriptions = 2;
  hub->SetLimits(limits);
  EXPECT_FALSE(watches(newcomer, 2));
  EXPECT_GT(hub->num_subscriptions(), 2u) << "whatever is there stays";
  limits.max_all_subscriptions = 1'000;
  hub->SetLimits(limits);
  EXPECT_TRUE(watches(newcomer, 3));
}

TEST_F(SubscribersTest, TooManyNamesAreAnError) {
  // 256 regions with 9 maps are 2,304 weights; 8 maps are the maximum of one subscription.
  wrinkle::Rig rig = MakeRig(false);
  wrinkle::Region region = rig.regions[0];
  const wrinkle::Feed feed = region.feeds[0];
  region.feeds.clear();
  rig.wrinkle_maps.clear();
  for (int map = 0; map < 9; ++map) {
    region.feeds.push_back(feed);
    region.feeds.back().map = "m" + std::to_string(map);
    rig.wrinkle_maps.push_back({.name = region.feeds.back().map});
  }
  rig.regions.assign(256, region);
  for (int i = 0; i < 256; ++i) rig.regions[i].name = std::string(60, 'r') + std::to_string(i);
  const std::string fitting = "*m0,*m1,*m2,*m3,*m4,*m5,*m6,*m7";
  MakeWith(std::move(rig));
  Connect(&sender);
  Connect(&viewer);
  Publish(sender, "ann");
  Send(viewer, protocol::SubscribeWeights{.subject = "ann"}, 0, 1);
  ExpectError(viewer, ErrorCode::kLimit);
  EXPECT_EQ(hub->num_subscriptions(), 0u);
  EXPECT_NE(Watch(viewer, {.subject = "ann", .pattern = fitting}), 0);
  FakePeer udp;
  Connect(&udp, Transport::kUdp);
  Send(udp, protocol::SubscribeWeights{.subject = "ann", .pattern = fitting}, 0, 1);
  ExpectError(udp, ErrorCode::kLimit);
}

}  // namespace
}  // namespace furrow::server
