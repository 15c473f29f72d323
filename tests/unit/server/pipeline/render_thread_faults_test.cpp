// SPDX-License-Identifier: Apache-2.0
// The render thread with a fake renderer that fails on demand.
#include <cstdint>
#include <latch>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/status.h"
#include "server/pipeline/render_thread.h"
#include "tests/log_capture.h"
#include "tests/unit/server/pipeline/fake_video.h"
#include "tests/unit/server/pipeline/render_thread_fixture.h"

namespace furrow::server {
namespace {

TEST_F(RenderThreadTest, ALostContextIsCreatedAgain) {
  script.submit = {Status(), kLost};
  Start();
  Submit(1);
  EXPECT_EQ(pictures.Take().sequence, 1u);
  Submit(2);  // lost
  Submit(3);
  EXPECT_EQ(pictures.Take().sequence, 3u);
  EXPECT_EQ(script.num_created, 2);
  EXPECT_EQ(Count(Counter::kRendererRestarts), 1u);
  EXPECT_EQ(Count(Counter::kPicturesFailed), 1u);
  EXPECT_EQ(Count(Counter::kPicturesRendered), 2u);
}

TEST_F(RenderThreadTest, PicturesInFlightFailWithTheContext) {
  std::latch both_wait(1);
  script.hold_first_submit = &both_wait;
  script.poll = {kLost};
  Start();
  Submit(1);
  Submit(2);
  both_wait.count_down();
  Submit(3);
  EXPECT_EQ(pictures.Take().sequence, 3u);
  EXPECT_EQ(Count(Counter::kRendererRestarts), 1u);
  EXPECT_EQ(Count(Counter::kPicturesFailed), 2u);
  EXPECT_EQ(pictures.num_failed_tickets(), 2u);  // failures are delivered
}

TEST_F(RenderThreadTest, AttemptsBecomeRarerWhileCreationFails) {
  script.create = {Status(), kLost, kLost};
  script.submit = {kLost};
  Start();
  // Job 1 loses the context. Creation fails for job 2, so job 3 is skipped; it fails again for job
  // 4, so three more are skipped.
  for (std::uint32_t number = 1; number <= 8; ++number) Submit(number);
  EXPECT_EQ(pictures.Take().sequence, 8u);
  EXPECT_EQ(script.num_created, 2);
  EXPECT_EQ(Count(Counter::kRendererRestarts), 1u);
  EXPECT_EQ(Count(Counter::kPicturesFailed), 7u);
  // After a success, the next loss is repaired at once.
  script.submit = {kLost};
  Submit(9);
  Submit(10);
  EXPECT_EQ(pictures.Take().sequence, 10u);
}

TEST_F(RenderThreadTest, AFailedJobDoesNotAffectOthers) {
  script.submit = {Status(StatusCode::kInvalidArgument, "no such size")};
  Start();
  Submit(1);
  Submit(2);
  EXPECT_EQ(pictures.Take().sequence, 2u);
  EXPECT_EQ(script.num_created, 1);
  EXPECT_EQ(Count(Counter::kRendererRestarts), 0u);
  EXPECT_EQ(Count(Counter::kPicturesFailed), 1u);
}

TEST_F(RenderThreadTest, LackOfMemoryCostsPicturesNotTheThread) {
  Start();
  script.out_of_memory_submits = 1;
  script.out_of_memory_polls = 1;
  // The first is lost while it is drawn, the second while it is read back.
  for (std::uint32_t number = 1; number <= 6; ++number) Submit(number);
  EXPECT_GE(pictures.Take().sequence, 3u);
  EXPECT_EQ(Count(Counter::kAllocationsFailed), 2u);
  EXPECT_EQ(Count(Counter::kRendererRestarts), 2u);
}

TEST_F(RenderThreadTest, AStillThatNeedsTooMuchMemoryHasFewerSamples) {
  script.submit = {Status(StatusCode::kLimit, "too much")};
  Start();
  Submit(1, {.subscription = 1, .still = true}, {});
  EXPECT_EQ(pictures.Take().sequence, 1u);
  thread.reset();
  EXPECT_EQ(script.samples, (std::deque<int>{0}));
}

TEST_F(RenderThreadTest, AnEncoderThatFailsLeavesJpeg) {
  test::fake_video = {.fails_after = 1};
  VideoEncoders encoders(test::FakeVideoCodec(), 8);
  const LogCapture log;
  Start(&encoders);
  ASSERT_TRUE(thread->OpenVideo(1, "a", {16, 16, 80}));
  std::vector<std::string> codecs;
  for (int picture = 0; picture < 3; ++picture) {
    RenderJob job = JobOf(1);
    job.tickets = {{.subscription = 1, .video = render::VideoTarget()}};
    thread->Submit(std::move(job));
    codecs.push_back(pictures.Take().codec);
  }
  EXPECT_EQ(codecs, (std::vector<std::string>{"avc1.42c01e", "", ""}));
  EXPECT_NE(log.text().find("the fake encoder failed"), std::string::npos) << log.text();
  EXPECT_FALSE(thread->OpenVideo(1, "a", {16, 16, 80}));
  thread.reset();
}

TEST_F(RenderThreadTest, ARendererThatDoesNotRespondTurnsPicturesOff) {
  std::latch go_on(1), holds(1);
  script.hold_first_submit = &go_on;
  script.in_first_submit = &holds;
  const LogCapture log;
  Start();
  Submit(1);
  holds.wait();
  Submit(2);  // waits
  const Time begun = FromSeconds(100);
  thread->Watch(begun);
  thread->Watch(begun + RenderThread::kStuckAfter - FromSeconds(1));
  EXPECT_FALSE(thread->is_stuck());
  thread->Watch(begun + RenderThread::kStuckAfter);
  EXPECT_TRUE(thread->is_stuck());
  EXPECT_EQ(pictures.num_failed_tickets(), 1u) << "the one that waits";
  Submit(3);
  EXPECT_EQ(pictures.num_failed_tickets(), 2u) << "and each new one, at once";
  thread->Watch(begun + FromSeconds(1000));
  EXPECT_EQ(Count(Counter::kRendererStuck), 1u);
  EXPECT_NE(log.text().find("has not responded for 30 s"), std::string::npos) << log.text();
  // It comes back.
  go_on.count_down();
  EXPECT_EQ(pictures.Take().sequence, 1u);
  while (thread->is_stuck()) thread->Watch(begun + FromSeconds(1001));
  EXPECT_NE(log.text().find("the renderer responds again"), std::string::npos);
  Submit(4);
  EXPECT_EQ(pictures.Take().sequence, 4u);
}

TEST_F(RenderThreadTest, ALongFrameIsNotARendererThatHangs) {
  script.passes = 3;
  const Time begun = FromSeconds(100);
  script.on_pass = [&](int pass) {
    // Each pass takes almost as long as a renderer may be silent.
    thread->Watch(begun + pass * (RenderThread::kStuckAfter - FromSeconds(1)));
    EXPECT_FALSE(thread->is_stuck()) << "in pass " << pass;
  };
  Start();
  Submit(1);
  EXPECT_EQ(pictures.Take().sequence, 1u);
  EXPECT_EQ(Count(Counter::kRendererStuck), 0u);
}

}  // namespace
}  // namespace furrow::server
