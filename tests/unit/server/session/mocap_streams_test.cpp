// SPDX-License-Identifier: Apache-2.0
// Frames of foreign mocap wires become subjects.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using testing::ElementsAre;
using testing::FloatEq;

class MocapStreamsTest : public HubPeersTest {};

TEST_F(MocapStreamsTest, ARejectedSubjectIsCountedAndRetried) {
  Limits limits;
  limits.max_subjects = 1;
  limits.idle_seconds = 5;
  Make(limits);
  Connect(&sender);
  Publish(sender, "ben");
  FakePeer tracker;
  Connect(&tracker, Transport::kMocap);
  protocol::mocap::NeutralFrame frame;
  frame.subject = "phone";
  frame.layout = 1;
  frame.blend_shapes = {{"nose", 0.5f}};
  for (; frame.sequence < 10; ++frame.sequence) hub->OnMocapFrame(tracker.id, frame, now);
  EXPECT_EQ(Count(Counter::kMocapRefused), 10u);
  EXPECT_EQ(Count(Counter::kSkeletonsRejected), 1u);
  Send(sender, protocol::Goodbye{}, 1);
  hub->Tick(now);
  ASSERT_EQ(hub->num_subjects(), 0u);
  Advance(1);
  hub->OnMocapFrame(tracker.id, frame, now);
  EXPECT_EQ(hub->num_subjects(), 1u) << "there is room now";
  EXPECT_EQ(Count(Counter::kMocapRefused), 10u);
}

TEST_F(MocapStreamsTest, FramesBecomeASubject) {
  FakePeer tracker;
  Connect(&tracker, Transport::kMocap);
  Watch(viewer, {.subject = "phone", .wait = true});
  protocol::mocap::NeutralFrame frame;
  frame.subject = "phone";
  frame.layout = 1;
  frame.blend_shapes = {{"nose", 0.5f}, {"other", 1.0f}};
  hub->OnMocapFrame(tracker.id, frame, now);
  viewer.Take<protocol::SubscribeReply>();
  EXPECT_THAT(viewer.Take<protocol::WeightFrame>()->message.values,
              ElementsAre(FloatEq(0.0f), FloatEq(0.5f)));
  frame.sequence = 1;
  frame.layout = 2;  // a new blend shape appears
  frame.blend_shapes.push_back({"brow", 1.0f});
  hub->OnMocapFrame(tracker.id, frame, now);
  EXPECT_THAT(viewer.Take<protocol::WeightFrame>()->message.values,
              ElementsAre(FloatEq(1.0f), FloatEq(0.5f)));
  frame.sequence = 2;
  frame.tracked = false;
  hub->OnMocapFrame(tracker.id, frame, now);
  EXPECT_TRUE(viewer.inbox.empty()) << "lost by its tracker: nothing new";
}

TEST_F(MocapStreamsTest, TimecodesReachSubjectWeightsAndRelayedPoses) {
  FakePeer tracker;
  Connect(&tracker, Transport::kMocap);
  Watch(viewer, {.subject = "phone", .wait = true});
  FakePeer recorder;
  Connect(&recorder);
  Send(recorder, protocol::SubscribePoses{.subject = "phone", .wait = true}, 0, 1);
  protocol::mocap::NeutralFrame frame;
  frame.subject = "phone";
  frame.layout = 1;
  frame.blend_shapes = {{"nose", 0.5f}};
  frame.timecode = MakeTimecode(17'982, 0.0, 30'000, 1001);
  hub->OnMocapFrame(tracker.id, frame, now);
  EXPECT_EQ(hub->subjects().all().front()->timecode, frame.timecode);
  viewer.Take<protocol::SubscribeReply>();
  EXPECT_EQ(viewer.Take<protocol::WeightFrame>()->message.timecode, frame.timecode);
  EXPECT_TRUE(recorder.Take<protocol::SubscribeReply>()->message.subject.empty());
  EXPECT_EQ(recorder.Take<protocol::SubscribeReply>()->message.subject, "phone");
  recorder.Take<protocol::SkeletonOffer>();
  EXPECT_EQ(recorder.Take<protocol::PoseFrame>()->message.timecode, frame.timecode);
  ++frame.sequence;
  frame.timecode.reset();
  hub->OnMocapFrame(tracker.id, frame, now);
  EXPECT_FALSE(hub->subjects().all().front()->timecode) << "it is not kept";
  EXPECT_FALSE(viewer.Take<protocol::WeightFrame>()->message.timecode);
}

// A phone without a face is neither lost nor forgotten while it sends.
TEST_F(MocapStreamsTest, AFaceOutOfViewIsAStateOfItsOwn) {
  Limits limits;
  limits.loss_seconds = 0.5;
  limits.idle_seconds = 3;
  Make(limits);
  FakePeer tracker;
  Connect(&tracker, Transport::kMocap);
  protocol::mocap::NeutralFrame frame;
  frame.subject = "phone";
  frame.layout = 1;
  frame.blend_shapes = {{"nose", 0.5f}};
  frame.tracked = false;
  const auto send = [&](int frames) {
    for (int i = 0; i < frames; ++i, ++frame.sequence) {
      Advance(0.2);
      hub->OnMocapFrame(tracker.id, frame, now);
      hub->Tick(now);
    }
  };
  send(1);
  ASSERT_EQ(hub->num_subjects(), 1u) << "listed before its first face";
  const Subject& subject = *hub->subjects().all().front();
  EXPECT_TRUE(subject.no_face);
  EXPECT_FALSE(subject.pipeline->has_pose());
  frame.tracked = true;
  send(1);
  EXPECT_FALSE(subject.no_face);
  EXPECT_TRUE(subject.pipeline->has_pose());
  frame.tracked = false;
  send(30);  // 6 seconds
  ASSERT_EQ(hub->num_subjects(), 1u) << "not idle";
  EXPECT_TRUE(subject.no_face);
  EXPECT_LT(subject.pipeline->wrinkle_weights()[1], 0.5f) << "decays";
  EXPECT_EQ(Count(Counter::kSubjectsLost), 0u);
  Advance(1);
  hub->Tick(now);  // the phone is silent, too
  EXPECT_FALSE(subject.no_face);
  EXPECT_TRUE(subject.lost);
  EXPECT_EQ(Count(Counter::kSubjectsLost), 1u);
  frame.tracked = true;
  send(1);
  EXPECT_FALSE(subject.lost);
}

}  // namespace
}  // namespace furrow::server
