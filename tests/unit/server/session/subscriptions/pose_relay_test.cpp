// SPDX-License-Identifier: Apache-2.0
// Subscriptions to poses: unchanged payloads, whole poses, losses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using protocol::ErrorCode;
using testing::ElementsAre;
using testing::FloatEq;

// Accepts frames for subscriptions to every frame only while there is room.
class SlowPeer : public FakePeer {
 public:
  int SendFrame(std::uint64_t key, std::span<const std::uint8_t> message, std::size_t keep,
                int shard) override {
    kept.push_back(keep);
    return room-- > 0 ? FakePeer::SendFrame(key, message, keep, shard) : 1;
  }
  int room = 1'000'000;
  std::vector<std::size_t> kept;
};

class PoseRelayTest : public HubTest {
 protected:
  void SetUp() override {
    HubTest::SetUp();
    Connect(&sender);
    Connect(&viewer);
  }
  // Subscribes, takes the reply and the skeleton, and returns the id.
  std::uint16_t Follow(const protocol::SubscribePoses& request) {
    Send(viewer, request, 0, 5);
    const auto reply = viewer.Take<protocol::SubscribeReply>();
    EXPECT_TRUE(reply && viewer.Take<protocol::SkeletonOffer>());
    return reply ? reply->header.stream : 0;
  }
  FakePeer sender;
  SlowPeer viewer;
};

TEST_F(PoseRelayTest, TheSkeletonComesFirstThenUnchangedPoses) {
  Publish(sender, "ann");
  Send(viewer, protocol::SubscribePoses{.subject = "ann"}, 0, 5);
  const auto reply = viewer.Take<protocol::SubscribeReply>();
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->message.subject, "ann");
  EXPECT_NE(reply->message.publisher_session, 0u);
  EXPECT_NE(reply->message.publisher_session, sender.session) << "that is the sender's secret";
  EXPECT_TRUE(reply->message.names.empty());
  const auto skeleton = viewer.Take<protocol::SkeletonOffer>();
  ASSERT_TRUE(skeleton.has_value());
  EXPECT_EQ(skeleton->header.stream, reply->header.stream);
  EXPECT_EQ(skeleton->message, Offer("ann"));

  std::vector<std::uint8_t> published;
  encoder.Encode({sender.session, 1, 7, 123}, Pose(0.25f, 0.5f), published,
                 protocol::PoseEncoding::Small());
  hub->OnMessage(sender.id, published, now);
  ASSERT_EQ(viewer.inbox.size(), 1u);
  const std::vector<std::uint8_t>& relayed = viewer.inbox.front();
  protocol::MessageView view;
  ASSERT_EQ(protocol::OpenMessage(relayed, view), protocol::DecodeStatus::kOk);
  EXPECT_EQ(view.header, (protocol::Header{4242, reply->header.stream, 7, 123}));
  EXPECT_TRUE(
      std::ranges::equal(view.payload, std::span(published).subspan(protocol::kEnvelopeBytes)));
  EXPECT_EQ(Count(Counter::kPosesRelayed), 1u);
}

TEST_F(PoseRelayTest, DroppedPosesAndDecayAreNotRelayed) {
  Publish(sender, "ann");
  Follow({});
  Send(sender, Pose(0.5f), 1, 10);
  Send(sender, Pose(0.6f), 1, 9);   // late
  Send(sender, Pose(0.5f), 1, 10);  // twice
  EXPECT_EQ(viewer.inbox.size(), 1u);
  for (int i = 0; i < 20; ++i) {
    Advance(0.1);
    hub->Tick(now);
  }
  EXPECT_EQ(viewer.inbox.size(), 1u);
}

TEST_F(PoseRelayTest, APartialPoseIsRelayedWhole) {
  Publish(sender, "ann");
  Follow({});
  Send(sender, Pose(0.25f, 0.5f), 1, 0);
  protocol::PoseFrame partial = Pose(0.75f);
  partial.partial = true;
  partial.blend_shape_indices = {0};
  partial.blend_shapes = {0.75f};
  Send(sender, partial, 1, 1);
  ASSERT_TRUE(viewer.Take<protocol::PoseFrame>().has_value());
  const auto whole = viewer.Take<protocol::PoseFrame>();
  ASSERT_TRUE(whole.has_value());
  EXPECT_FALSE(whole->message.partial);
  EXPECT_EQ(whole->message.skeleton_hash, Offer("ann").skeleton_hash);
  EXPECT_THAT(whole->message.blend_shapes, ElementsAre(FloatEq(0.75f), FloatEq(0.5f)));
}

TEST_F(PoseRelayTest, ALateSubscriberReceivesTheNewestPoseAtOnce) {
  Publish(sender, "ann");
  Send(sender, Pose(0.25f, 0.5f), 1, 3);
  Follow({});
  hub->Tick(now);
  const auto pose = viewer.Take<protocol::PoseFrame>();
  ASSERT_TRUE(pose.has_value());
  EXPECT_EQ(pose->header.sequence, 3u);
  hub->Tick(now);
  EXPECT_TRUE(viewer.inbox.empty());
}

TEST_F(PoseRelayTest, ANewSessionIsAnnouncedBeforeItsFirstPose) {
  Publish(sender, "ann");
  Send(viewer, protocol::SubscribePoses{.subject = "ann"}, 0, 5);
  const std::uint64_t first = viewer.Take<protocol::SubscribeReply>()->message.publisher_session;
  viewer.inbox.clear();
  Publish(sender, "ann");  // again
  EXPECT_TRUE(viewer.inbox.empty());
  sender.session = 78;
  Publish(sender, "ann");
  Send(sender, Pose(0.5f), 1, 0);
  const auto reply = viewer.Take<protocol::SubscribeReply>();
  ASSERT_TRUE(reply.has_value());
  EXPECT_NE(reply->message.publisher_session, first);
  EXPECT_TRUE(viewer.Take<protocol::SkeletonOffer>().has_value());
  EXPECT_TRUE(viewer.Take<protocol::PoseFrame>().has_value());
}

TEST_F(PoseRelayTest, AWaitingSubscriptionIsAnsweredWhenTheSubjectAppears) {
  Send(viewer, protocol::SubscribePoses{.subject = "ann", .wait = true}, 0, 5);
  auto reply = viewer.Take<protocol::SubscribeReply>();
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->message.subject, "");
  EXPECT_EQ(reply->message.publisher_session, 0u);
  Publish(sender, "ann");
  reply = viewer.Take<protocol::SubscribeReply>();
  EXPECT_EQ(reply->message.subject, "ann");
  EXPECT_TRUE(viewer.Take<protocol::SkeletonOffer>().has_value());
}

TEST_F(PoseRelayTest, FramesFollowTheOrderOfSubscriptions) {
  for (std::uint32_t request = 0; request < 40; ++request) {
    Send(viewer, protocol::SubscribePoses{.subject = "ann", .wait = true}, 0, 2 * request);
    Send(viewer, protocol::SubscribeWeights{.subject = "ann", .wait = true}, 0, 2 * request + 1);
  }
  Publish(sender, "ann");
  viewer.inbox.clear();
  Send(sender, Pose(0.5f), 1, 0);
  ASSERT_EQ(viewer.inbox.size(), 64u) << "as many as a peer may have";
  for (std::size_t i = 0; i < viewer.inbox.size(); ++i) {
    protocol::MessageView view;
    ASSERT_EQ(protocol::OpenMessage(viewer.inbox[i], view), protocol::DecodeStatus::kOk);
    EXPECT_EQ(view.kind,
              i % 2 == 0 ? protocol::MessageKind::kPose : protocol::MessageKind::kWeights);
  }
}

TEST_F(PoseRelayTest, ARepeatedRequestIsAnsweredWithTheSkeletonAgain) {
  Publish(sender, "ann");
  const std::uint16_t id = Follow({.subject = "ann"});
  EXPECT_EQ(Follow({.subject = "ann"}), id);
  EXPECT_EQ(hub->num_subscriptions(), 1u);
}

TEST_F(PoseRelayTest, ARateSkipsPoses) {
  Publish(sender, "ann");
  Follow({.max_rate_hz = 10.0f});
  for (std::uint32_t i = 0; i < 60; ++i) {
    Send(sender, Pose(0.5f), 1, i);
    Advance(1.0 / 60.0);
  }
  EXPECT_NEAR(static_cast<double>(viewer.inbox.size()), 10.0, 1.0);
}

TEST_F(PoseRelayTest, LostPosesAreReportedAtMostOncePerSecond) {
  Publish(sender, "ann");
  const std::uint16_t id = Follow({.every = true});
  viewer.room = 2;
  for (std::uint32_t i = 0; i < 5; ++i) Send(sender, Pose(0.5f), 1, i);
  EXPECT_THAT(viewer.kept, testing::Each(kKeepAll));
  viewer.inbox.clear();
  hub->Tick(now);
  const auto told = viewer.Take<protocol::Dropped>();
  ASSERT_TRUE(told.has_value());
  EXPECT_EQ(told->header.stream, id);
  EXPECT_EQ(told->message.frames, 3u);
  EXPECT_EQ(Count(Counter::kPosesDroppedSlow), 3u);
  Send(sender, Pose(0.5f), 1, 5);
  Advance(0.1);
  hub->Tick(now);
  EXPECT_TRUE(viewer.inbox.empty());
  Advance(1.0);
  hub->Tick(now);
  EXPECT_EQ(viewer.Take<protocol::Dropped>()->message.frames, 4u);
  Advance(2.0);
  hub->Tick(now);
  for (const auto& message : viewer.inbox) {
    protocol::MessageView view;
    ASSERT_EQ(protocol::OpenMessage(message, view), protocol::DecodeStatus::kOk);
    EXPECT_NE(view.kind, protocol::MessageKind::kDropped) << "nothing more was dropped";
  }
}

TEST_F(PoseRelayTest, EveryWeightIsKeptOnRequest) {
  Publish(sender, "ann");
  Send(viewer, protocol::SubscribeWeights{.every = true}, 0, 1);
  Send(viewer, protocol::SubscribeWeights{}, 0, 2);
  Send(sender, Pose(0.5f), 1, 0);
  EXPECT_THAT(viewer.kept, testing::UnorderedElementsAre(kKeepAll, testing::Lt(100u)));
}

TEST_F(PoseRelayTest, ASkeletonTooLargeForUdpIsRefused) {
  protocol::SkeletonOffer large;
  large.subject = "ann";
  for (int i = 0; i < 600; ++i) {
    protocol::OfferedJoint joint;
    joint.name = std::string(200, 'j') + std::to_string(i);
    joint.parent = static_cast<std::int16_t>(i - 1);
    large.joints.push_back(joint);
  }
  Send(sender, large, 1);
  ASSERT_TRUE(sender.Take<protocol::SkeletonReply>().has_value());
  FakePeer udp;
  Connect(&udp, Transport::kUdp);
  Send(udp, protocol::SubscribePoses{.subject = "ann"});
  const auto error = udp.Take<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->message.code, ErrorCode::kLimit);
  EXPECT_EQ(hub->num_subscriptions(), 0u);
}

// Frames are ordered by (sequence, age), so weights without a new pose follow the pose.
TEST_F(PoseRelayTest, ChangedWeightsOfTheSamePoseAreNotRelayed) {
  Publish(sender, "ann");
  Follow({.subject = "ann"});
  FakePeer weights;
  Connect(&weights);
  Watch(weights, {.subject = "ann"});
  Send(sender, Pose(0.5f), 1, 1);
  ASSERT_TRUE(viewer.Take<protocol::PoseFrame>().has_value());
  ASSERT_TRUE(weights.Take<protocol::WeightFrame>().has_value());
  Subject& subject = *hub->RequireAllDrivers("ann");
  hub->SetNeutral(subject, subject.pipeline->pose(), now);
  EXPECT_EQ(weights.Take<protocol::WeightFrame>()->message.age_us, 1);
  Advance(0.25);
  ASSERT_TRUE(hub->SetRig(std::make_shared<const wrinkle::Rig>(hub->rig()), now).ok());
  EXPECT_EQ(weights.Take<protocol::WeightFrame>()->message.age_us, 250'000);
  EXPECT_TRUE(viewer.inbox.empty());
}

TEST_F(PoseRelayTest, AnEndedSubjectEndsItsSubscription) {
  Publish(sender, "ann");
  Follow({.subject = "ann"});
  Send(sender, protocol::Goodbye{}, 1);
  hub->Tick(now);
  EXPECT_EQ(viewer.Take<protocol::Goodbye>()->message.reason,
            protocol::GoodbyeReason::kSubjectGone);
  EXPECT_EQ(hub->num_subscriptions(), 0u);
}

}  // namespace
}  // namespace furrow::server
