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

}  // namespace
}  // namespace furrow::server
