// SPDX-License-Identifier: Apache-2.0
#include "server/session/trace/pose_tracer.h"

#include <array>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using State = PoseTracer::State;

class PoseTracerTest : public HubPeersTest {
 protected:
  const PoseTracer& tracer() const { return *hub->tracer(); }
  // A picture of this pose, as the renderer delivers it.
  FinishedPicture PictureOf(std::uint32_t sequence) const {
    FinishedPicture picture;
    picture.subject = hub->subjects().all().front()->id;
    picture.sequence = sequence;
    picture.submitted = now + FromSeconds(0.1);
    picture.taken = now + FromSeconds(0.2);
    picture.drawn = now + FromSeconds(0.3);
    picture.encoded = now + FromSeconds(0.4);
    picture.bytes = {1, 2, 3};
    return picture;
  }
};

TEST_F(PoseTracerTest, TheNextPoseOfTheSubjectIsFollowedOnce) {
  Publish(sender, "ann", 1);
  Publish(sender, "ben", 2);
  Watch(viewer, {.subject = "ben"});
  Send(sender, Pose(0.1f), 2, 0);
  EXPECT_EQ(clock_reads, 0) << "nobody asked for a trace";
  EXPECT_EQ(tracer().state(), State::kNone);
  ASSERT_NE(hub->Trace("ben"), nullptr);
  EXPECT_EQ(tracer().state(), State::kWaiting);
  Send(sender, Pose(0.1f), 1, 0);
  EXPECT_EQ(tracer().state(), State::kWaiting) << "a pose of another subject";
  Send(sender, Pose(0.2f), 2, 1, 5'000'000);
  ASSERT_EQ(tracer().state(), State::kDone);
  const PoseTrace first = tracer().trace();
  EXPECT_EQ(first.subject, "ben");
  EXPECT_EQ(first.sequence, 1u);
  EXPECT_EQ(first.batch, 1u);
  EXPECT_TRUE(first.late.has_value());
  const int reads = clock_reads;
  Advance(0.1);
  Send(sender, Pose(0.3f), 2, 2, 5'100'000);
  EXPECT_EQ(tracer().trace().sequence, 1u);
  EXPECT_EQ(clock_reads, reads);
}

TEST_F(PoseTracerTest, TheStagesFollowEachOther) {
  Publish(sender, "ann");
  Watch(viewer, {.subject = "ann"});
  hub->Trace("ann");
  Send(sender, Pose(0.2f), 1, 1);
  const PoseTrace& trace = tracer().trace();
  const std::array times{trace.received, trace.accepted,  trace.solving,
                         trace.solved,   trace.published, trace.sent};
  EXPECT_EQ(times.front(), now);
  for (std::size_t i = 1; i < times.size(); ++i) EXPECT_GT(times[i], times[i - 1]) << i;
}

// Poses of several subjects in one batch, and two of the followed subject.
TEST_F(PoseTracerTest, AnotherPoseOfTheBatchChangesNothing) {
  Publish(sender, "ann", 1);
  Publish(sender, "ben", 2);
  hub->Trace("ben");
  std::vector<std::vector<std::uint8_t>> messages(3);
  encoder.Encode({sender.session, 1, 7, 0}, Pose(0.1f), messages[0]);
  encoder.Encode({sender.session, 2, 8, 0}, Pose(0.2f), messages[1]);
  encoder.Encode({sender.session, 2, 9, 0}, Pose(0.3f), messages[2]);
  {
    const Hub::ShardLock lock(*hub, 0);
    for (const auto& message : messages) hub->GatherMessage(sender.id, message, now);
  }
  EXPECT_EQ(tracer().state(), State::kDone);
  EXPECT_EQ(tracer().trace().sequence, 8u);
  EXPECT_EQ(tracer().trace().batch, 2u) << "the next pose of ben needs a batch of its own";
  EXPECT_LT(tracer().trace().published, tracer().trace().sent);
}

TEST_F(PoseTracerTest, ThePictureIsTheFirstThatShowsThePose) {
  Publish(sender, "ann");
  hub->Trace("ann");
  Send(sender, Pose(0.2f), 1, 10);
  hub->OnPicture(PictureOf(9), now);
  EXPECT_FALSE(tracer().trace().picture) << "of an earlier pose";
  FinishedPicture failed = PictureOf(10);
  failed.bytes.clear();
  hub->OnPicture(failed, now);
  FinishedPicture other = PictureOf(10);
  ++other.subject;
  hub->OnPicture(other, now);
  EXPECT_FALSE(tracer().trace().picture);
  hub->OnPicture(PictureOf(12), now);
  hub->OnPicture(PictureOf(13), now);
  ASSERT_TRUE(tracer().trace().picture);
  EXPECT_EQ(tracer().trace().picture->sequence, 12u);
  EXPECT_EQ(tracer().trace().picture->bytes, 3u);
  EXPECT_EQ(tracer().trace().picture->drawn, now + FromSeconds(0.3));
}

TEST_F(PoseTracerTest, ASubjectThatIsNotThereCannotBeFollowed) {
  EXPECT_EQ(hub->Trace("ann"), nullptr);
  EXPECT_EQ(hub->Trace(""), nullptr);
  EXPECT_EQ(tracer().state(), State::kNone);
  Publish(sender, "ann");
  EXPECT_EQ(hub->Trace("")->name, "ann") << "the oldest";
  EXPECT_EQ(hub->Trace("ann", Access()), nullptr) << "who may see nothing";
}

}  // namespace
}  // namespace furrow::server
