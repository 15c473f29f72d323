// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "fake_cluster.h"
#include "hub_fixture.h"

namespace furrow::server {
namespace {

class HubClusterTest : public HubPeersTest {
 protected:
  HubClusterTest() { cluster = &nodes; }

  void ExpectSentAway(FakePeer& peer, protocol::ErrorCode code) {
    const auto error = peer.Take<protocol::ErrorMessage>();
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->message.code, code);
    EXPECT_EQ(error->message.host, "host-b");
    EXPECT_EQ(error->message.tcp, 1);
    EXPECT_EQ(error->message.udp, 2);
    EXPECT_EQ(error->message.message, "'ada' is served by the node 'b' at host-b");
  }
  void Serve(double seconds, std::uint64_t epoch) {
    nodes.places["ada"] = FakeCluster::Here(now + FromSeconds(seconds), epoch);
  }
  void Tick() {
    now += Places::kRefresh;
    hub->Tick(now);
  }

  FakeCluster nodes;
};

TEST_F(HubClusterTest, AnOfferWaitsForItsPlace) {
  Place pending;
  pending.kind = Place::Kind::kPending;
  nodes.places["ada"] = pending;
  Send(sender, Offer("ada"), 1);
  EXPECT_TRUE(sender.inbox.empty());
  EXPECT_EQ(hub->num_subjects(), 0u);
  Serve(2.0, 10);
  Publish(sender, "ada");
  EXPECT_EQ(hub->num_subjects(), 1u);
}

TEST_F(HubClusterTest, AnOfferWithoutAPlaceIsAnsweredWithTheReason) {
  nodes.places["ada"].why = "no room";
  Send(sender, Offer("ada"), 1);
  const auto error = sender.Take<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->message.code, protocol::ErrorCode::kLimit);
  EXPECT_EQ(error->message.message, "'ada' has no place in the cluster: no room");
  EXPECT_EQ(error->message.host, "");
}

TEST_F(HubClusterTest, OffersAndSubscriptionsAreSentToTheServingNode) {
  nodes.places["ada"] = FakeCluster::At(FakeCluster::kOther);
  Send(sender, Offer("ada"), 1);
  ExpectSentAway(sender, protocol::ErrorCode::kSubjectTaken);
  for (const bool wait : {false, true}) {
    Send(viewer, protocol::SubscribeWeights{.subject = "ada", .wait = wait}, 0, 1);
    ExpectSentAway(viewer, protocol::ErrorCode::kUnknownSubject);
  }
  EXPECT_EQ(hub->num_subscriptions(), 0u);
  EXPECT_EQ(Count(Counter::kRedirected), 3u);
}

TEST_F(HubClusterTest, WaitingSubscriptionsFollowWhenTheSubjectAppearsElsewhere) {
  ASSERT_NE(Watch(viewer, {.subject = "ada", .wait = true}), 0);
  Tick();
  EXPECT_TRUE(viewer.inbox.empty());
  nodes.places["ada"] = FakeCluster::At(FakeCluster::kOther);
  Tick();
  ExpectSentAway(viewer, protocol::ErrorCode::kUnknownSubject);
  EXPECT_EQ(hub->num_subscriptions(), 0u);
}

TEST_F(HubClusterTest, NothingIsSentAfterTheEndOfALease) {
  Serve(2.0, 10);
  Publish(sender, "ada");
  ASSERT_NE(Watch(viewer, {.subject = "ada"}), 0);
  Send(sender, Pose(0.5f), 1, 0);
  EXPECT_TRUE(viewer.Take<protocol::WeightFrame>().has_value());
  // As if the daemon had been frozen: no tick in between.
  Advance(2.0);
  Send(sender, Pose(0.6f), 1, 1);
  EXPECT_EQ(Count(Counter::kPosesUnplaced), 1u);
  EXPECT_TRUE(viewer.inbox.empty());
  // Not even while the subject decays.
  nodes.places["ada"] = Place();
  for (int i = 0; i < 20; ++i) Tick();
  EXPECT_TRUE(viewer.inbox.empty());
  // The node gets the lease back.
  Serve(2.0, 11);
  Tick();
  const auto reply = viewer.Take<protocol::SubscribeReply>();
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->message.epoch, 11u);
  viewer.inbox.clear();
  Send(sender, Pose(0.7f), 1, 2);
  EXPECT_TRUE(viewer.Take<protocol::WeightFrame>().has_value());
}

TEST_F(HubClusterTest, SubscribersLearnOfAnEpochThatComesWithAnOffer) {
  Serve(2.0, 10);
  Publish(sender, "ada");
  ASSERT_NE(Watch(viewer, {.subject = "ada"}), 0);
  Serve(2.0, 11);
  Publish(sender, "ada");
  const auto reply = viewer.Take<protocol::SubscribeReply>();
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->message.epoch, 11u);
  Publish(sender, "ada");
  EXPECT_TRUE(viewer.inbox.empty());
}

TEST_F(HubClusterTest, AFloodOfOffersEndsNoPlace) {
  Limits limits;
  limits.max_subjects = 4;
  Make(limits);
  Connect(&sender);
  Connect(&viewer);
  Serve(2.0, 10);
  Publish(sender, "ada");
  Tick();
  Place pending;
  pending.kind = Place::Kind::kPending;
  for (const char* name : {"b", "c", "d", "e", "f"}) {
    nodes.places[name] = pending;
    Send(viewer, Offer(name), 1);
  }
  ExpectError(viewer, protocol::ErrorCode::kLimit);
  Serve(2.0, 10);
  Tick();
  Advance(1.8);
  Send(sender, Pose(0.5f), 1, 0);
  EXPECT_EQ(Count(Counter::kPosesUnplaced), 0u);
}

TEST_F(HubClusterTest, OwedFramesWaitForALeaseThatHasEnded) {
  Serve(2.0, 10);
  Publish(sender, "ada");
  ASSERT_NE(Watch(viewer, {.subject = "ada", .max_rate_hz = 1.0f}), 0);
  Send(sender, Pose(0.5f), 1, 0);
  EXPECT_TRUE(viewer.Take<protocol::WeightFrame>().has_value());
  Advance(0.1);
  Send(sender, Pose(0.6f), 1, 1);  // the rate holds it back
  EXPECT_TRUE(viewer.inbox.empty());
  // As if the daemon had been frozen until now.
  Advance(2.0);
  nodes.places["ada"] = Place();
  Tick();
  EXPECT_TRUE(viewer.inbox.empty());
  Serve(2.0, 11);
  Tick();
  EXPECT_TRUE(viewer.Take<protocol::SubscribeReply>().has_value());
  EXPECT_TRUE(viewer.Take<protocol::WeightFrame>().has_value());
}

TEST_F(HubClusterTest, PicturesAreNotSentAfterTheEndOfALease) {
  Serve(2.0, 10);
  Publish(sender, "ada");
  Send(sender, Pose(0.5f), 1, 0);
  Send(viewer, protocol::SubscribePictures{.subject = "ada", .width = 64, .height = 64}, 0, 1);
  ASSERT_TRUE(viewer.Take<protocol::SubscribeReply>().has_value());
  Tick();
  ASSERT_FALSE(pictures.jobs.empty());
  FinishedPicture picture;
  picture.width = picture.height = 64;
  picture.bytes = {1, 2, 3};
  picture.tickets = pictures.jobs.back().tickets;
  hub->OnPicture(picture, now);
  EXPECT_TRUE(viewer.Take<protocol::ImageFrame>().has_value());
  Advance(2.0);
  hub->OnPicture(picture, now);
  EXPECT_TRUE(viewer.inbox.empty());
}

TEST_F(HubClusterTest, ASubjectThatMovesTakesItsPeersAlong) {
  Serve(2.0, 10);
  Publish(sender, "ada", 3);
  ASSERT_NE(Watch(viewer, {.subject = "ada"}), 0);
  nodes.places["ada"] = FakeCluster::At(FakeCluster::kOther);
  Tick();
  ExpectSentAway(sender, protocol::ErrorCode::kSubjectTaken);
  ExpectSentAway(viewer, protocol::ErrorCode::kUnknownSubject);
  EXPECT_TRUE(viewer.inbox.empty());
  EXPECT_EQ(hub->num_subjects(), 0u);
  EXPECT_EQ(nodes.released, std::vector<std::string>{"ada"});
}

TEST_F(HubClusterTest, ASubjectWaitsForItsLeaseAlthoughAnotherNodeHasRoom) {
  Serve(2.0, 10);
  Publish(sender, "ada");
  nodes.places["ada"] = FakeCluster::At(FakeCluster::kOther);
  nodes.only_proposed = true;
  Tick();
  EXPECT_TRUE(sender.inbox.empty());
  EXPECT_EQ(hub->num_subjects(), 1u);
  // A new one goes there.
  Send(viewer, Offer("ada"), 1);
  ExpectSentAway(viewer, protocol::ErrorCode::kSubjectTaken);
}

TEST_F(HubClusterTest, APlaceThatNobodyUsesIsGivenBack) {
  Place pending;
  pending.kind = Place::Kind::kPending;
  nodes.places["ada"] = pending;
  Send(sender, Offer("ada"), 1);
  Tick();
  EXPECT_TRUE(nodes.released.empty());
  now += Places::kPatience;
  Tick();
  EXPECT_EQ(nodes.released, std::vector<std::string>{"ada"});
}

TEST_F(HubClusterTest, ADrainingNodeSendsItsPeersAwayBeforeItSaysGoodbye) {
  Serve(2.0, 10);
  Publish(sender, "ada");
  ASSERT_NE(Watch(viewer, {.subject = "ada"}), 0);
  nodes.successor = FakeCluster::At(FakeCluster::kOther);
  hub->Drain(now);
  EXPECT_TRUE(nodes.draining);
  EXPECT_EQ(nodes.released, std::vector<std::string>{"ada"});
  ExpectSentAway(sender, protocol::ErrorCode::kSubjectTaken);
  EXPECT_TRUE(sender.Take<protocol::Goodbye>().has_value());
  ExpectSentAway(viewer, protocol::ErrorCode::kUnknownSubject);
  EXPECT_TRUE(viewer.Take<protocol::Goodbye>().has_value());
}

TEST_F(HubClusterTest, ADrainingNodeUsesNoMorePosesOfWhatItReleased) {
  Serve(2.0, 10);
  Publish(sender, "ada");
  Send(sender, Pose(0.5f), 1, 0);
  EXPECT_EQ(Count(Counter::kPosesUnplaced), 0u);
  hub->Drain(now);
  sender.inbox.clear();
  Send(sender, Pose(0.6f), 1, 1);
  EXPECT_EQ(Count(Counter::kPosesUnplaced), 1u);
  // The coordinator still says that the subject is here.
  Send(sender, Offer("ada"), 1);
  const auto error = sender.Take<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->message.message, "'ada' has no place in the cluster: this node is draining");
  Send(sender, Pose(0.7f), 1, 2);
  EXPECT_EQ(Count(Counter::kPosesUnplaced), 2u);
}

TEST_F(HubClusterTest, AWelcomeListsTheOtherNodes) {
  Send(viewer, protocol::Hello{.client = "test"});
  const auto welcome = viewer.Take<protocol::Welcome>();
  ASSERT_TRUE(welcome.has_value());
  EXPECT_EQ(welcome->message.others, std::vector<std::string>{"host-b:1:2"});
}

}  // namespace
}  // namespace furrow::server
