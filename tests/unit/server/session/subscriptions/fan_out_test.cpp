// SPDX-License-Identifier: Apache-2.0
// Stuck subscribers cost nothing and receive the newest pose first when they read again.
#include <gtest/gtest.h>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

class FanOutTest : public HubPeersTest {
 protected:
  void Tick() {
    Advance(0.01);
    hub->Tick(now);
  }
  void SetStuck(bool stuck) {
    viewer.stuck = stuck;
    Tick();
  }
  // Sends poses 1 to `last`, one per tick.
  void SendPoses(std::uint32_t last) {
    for (std::uint32_t i = 1; i <= last; ++i) {
      Send(sender, Pose(static_cast<float>(i) * 0.1f), 1, i);
      Tick();
    }
  }
};

TEST_F(FanOutTest, AStuckPeerReceivesTheNewestPoseOnceItReads) {
  Publish(sender, "ann");
  Watch(viewer, {.subject = "ann"});
  SetStuck(true);
  SendPoses(5);
  EXPECT_TRUE(viewer.inbox.empty());
  EXPECT_EQ(Count(Counter::kWeightsDroppedSlow), 5u);
  EXPECT_EQ(Count(Counter::kWeightsSent), 0u);
  SetStuck(false);
  const auto frame = viewer.Take<protocol::WeightFrame>();
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->header.sequence, 5u);
  EXPECT_FLOAT_EQ(frame->message.values[0], 0.5f);
  Tick();
  EXPECT_TRUE(viewer.inbox.empty());
}

TEST_F(FanOutTest, QueuedFramesOfAStuckPeerAreDroppedOnce) {
  Publish(sender, "ann");
  Watch(viewer, {.subject = "ann"});
  SetStuck(true);
  EXPECT_TRUE(viewer.dropped_keys.empty()) << "nothing newer has come";
  SendPoses(3);
  EXPECT_EQ(viewer.dropped_keys.size(), 1u);
  SetStuck(false);
  SetStuck(true);
  SendPoses(3);
  EXPECT_EQ(viewer.dropped_keys.size(), 1u) << "late poses are none";
  Send(sender, Pose(1), 1, 10);
  EXPECT_EQ(viewer.dropped_keys.size(), 2u);
}

TEST_F(FanOutTest, OtherSubscribersContinue) {
  FakePeer other;
  Connect(&other);
  Publish(sender, "ann");
  Watch(viewer, {.subject = "ann"});
  Watch(other, {.subject = "ann"});
  SetStuck(true);
  SendPoses(3);
  EXPECT_EQ(other.inbox.size(), 3u);
}

TEST_F(FanOutTest, SubscriptionsToEveryFrameAreNotHeldBack) {
  Publish(sender, "ann");
  Watch(viewer, {.subject = "ann", .every = true});
  SetStuck(true);
  SendPoses(3);
  EXPECT_EQ(viewer.inbox.size(), 3u);
}

TEST_F(FanOutTest, PosesAreHeldBackLikeWeights) {
  Publish(sender, "ann");
  Send(viewer, protocol::SubscribePoses{.subject = "ann"}, 0, 1);
  ASSERT_TRUE(viewer.Take<protocol::SubscribeReply>().has_value());
  ASSERT_TRUE(viewer.Take<protocol::SkeletonOffer>().has_value());
  SetStuck(true);
  SendPoses(4);
  EXPECT_TRUE(viewer.inbox.empty());
  EXPECT_EQ(Count(Counter::kPosesDroppedSlow), 4u);
  SetStuck(false);
  const auto pose = viewer.Take<protocol::PoseFrame>();
  ASSERT_TRUE(pose.has_value());
  EXPECT_EQ(pose->header.sequence, 4u);
}

}  // namespace
}  // namespace furrow::server
