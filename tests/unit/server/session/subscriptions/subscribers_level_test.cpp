// SPDX-License-Identifier: Apache-2.0
// Only drivers that a subscription needs are evaluated, without a visible difference.
#include <gtest/gtest.h>

#include "tests/unit/server/session/hub_fixture.h"
#include "wrinkle/solver/solver.h"

namespace furrow::server {
namespace {

using wrinkle::kAllDrivers;

// The rig has the drivers brow and nose, in this order.
class DriverLevelTest : public HubPeersTest {
 protected:
  void SetUp() override {
    HubPeersTest::SetUp();
    Publish(sender, "ann");
  }
  // Not through RequireAllDrivers(), which raises the level.
  std::size_t Level() const { return hub->subjects().all().front()->pipeline->level(); }
};

TEST_F(DriverLevelTest, UnwatchedSubjectsAreNotEvaluated) {
  EXPECT_EQ(Level(), 0u);
  Send(sender, Pose(0.5f, 0.25f), 1, 0);
  for (const float weight : hub->subjects().all().front()->pipeline->wrinkle_weights()) {
    EXPECT_EQ(weight, 0.0f);
  }
}

TEST_F(DriverLevelTest, TheLevelFollowsTheSubscriptions) {
  const std::uint16_t brow = Watch(viewer, {.subject = "ann", .pattern = "brow*"}, 1);
  EXPECT_EQ(Level(), 1u);
  const std::uint16_t nose = Watch(viewer, {.subject = "ann", .pattern = "nose*"}, 2);
  EXPECT_EQ(Level(), 2u);
  Send(viewer, protocol::Unsubscribe{}, nose, 3);
  EXPECT_EQ(Level(), 1u);
  Send(viewer, protocol::Unsubscribe{}, brow, 4);
  EXPECT_EQ(Level(), 0u);
}

TEST_F(DriverLevelTest, ALateSubscriberReceivesAllWeightsOfTheCurrentPose) {
  Watch(viewer, {.subject = "ann", .pattern = "brow*"}, 1);
  Send(sender, Pose(0.5f, 0.75f), 1, 0);
  EXPECT_FLOAT_EQ(viewer.Take<protocol::WeightFrame>()->message.values[0], 0.5f);
  FakePeer late;
  Connect(&late);
  Watch(late, {.subject = "ann"});
  Advance(0.01);
  hub->Tick(now);
  const auto frame = late.Take<protocol::WeightFrame>();
  ASSERT_TRUE(frame.has_value());
  EXPECT_FLOAT_EQ(frame->message.values[0], 0.5f);
  EXPECT_FLOAT_EQ(frame->message.values[1], 0.75f);
}

TEST_F(DriverLevelTest, DriverValuesCountLikeWeights) {
  Watch(viewer,
        {.subject = "ann", .pattern = "brow*", .source = protocol::WeightSource::kDriverValues});
  EXPECT_EQ(Level(), 1u);
}

TEST_F(DriverLevelTest, PicturesAndTheApiNeedAllDrivers) {
  Send(viewer, protocol::SubscribePictures{.subject = "ann"}, 0, 1);
  EXPECT_EQ(Level(), kAllDrivers);
  hub->RemovePeer(viewer.id);
  EXPECT_EQ(Level(), 0u);
  ASSERT_NE(hub->RequireAllDrivers("ann"), nullptr);
  EXPECT_EQ(Level(), kAllDrivers);
}

TEST_F(DriverLevelTest, NewSkeletonsAndRigsKeepTheLevel) {
  Watch(viewer, {.subject = "ann", .pattern = "brow*"});
  ASSERT_TRUE(hub->SetRig(std::make_shared<const wrinkle::Rig>(MakeRig(false)), now).ok());
  EXPECT_EQ(Level(), 1u);
  protocol::SkeletonOffer offer = Offer("ann");
  offer.blend_shape_names = {"nose", "brow"};
  offer.skeleton_hash = protocol::SkeletonHash(offer);
  Send(sender, offer, 1);
  EXPECT_EQ(Level(), 1u);
}

TEST_F(HubTest, OscOutputNeedsAllDrivers) {
  Hub::Parts parts;
  parts.rig = std::make_shared<const wrinkle::Rig>(MakeRig(false));
  parts.metrics = &metrics;
  parts.random = [] { return std::uint64_t{1}; };
  hub = std::make_unique<Hub>(std::move(parts));
  hub->SetOnWeights([](const Subject&, int, Time) {});
  FakePeer sender;
  Connect(&sender);
  Publish(sender, "ann");
  const SubjectPipeline& pipeline = *hub->subjects().all().front()->pipeline;
  EXPECT_EQ(pipeline.level(), kAllDrivers);
  {
    const Hub::ExclusiveLock lock(*hub, 0);
    hub->SetOnWeights({});
  }
  EXPECT_EQ(pipeline.level(), 0u) << "nobody needs drivers";
  {
    const Hub::ExclusiveLock lock(*hub, 0);
    hub->SetOnWeights([](const Subject&, int, Time) {});
  }
  EXPECT_EQ(pipeline.level(), kAllDrivers);
}

}  // namespace
}  // namespace furrow::server
