// SPDX-License-Identifier: Apache-2.0
// The render thread with a fake renderer: how it starts, and how it stops.
#include <cstdint>
#include <future>
#include <latch>
#include <memory>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "base/status.h"
#include "server/pipeline/render_thread.h"
#include "tests/unit/server/pipeline/render_thread_fixture.h"

namespace furrow::server {
namespace {

TEST_F(RenderThreadTest, JobsWaitForARendererThatStartsLater) {
  std::promise<void> may_start;
  std::promise<Status> started;
  StartLater(
      [this, &may_start] {
        may_start.get_future().wait();
        return Create();
      },
      nullptr, &started);
  EXPECT_FALSE(thread->is_stuck());
  EXPECT_TRUE(thread->is_starting());
  EXPECT_EQ(thread->description(), "starting");
  EXPECT_EQ(thread->fault(), "");
  EXPECT_TRUE(thread->Preset("face").ok());
  EXPECT_EQ(thread->Preset("moon").status().code(), StatusCode::kNotFound);
  Submit(1);
  may_start.set_value();
  EXPECT_TRUE(started.get_future().get().ok());
  EXPECT_FALSE(thread->is_starting());
  EXPECT_NE(thread->description(), "starting");
  EXPECT_EQ(pictures.Take().sequence, 1u);
  EXPECT_EQ(pictures.num_failed_tickets(), 0u);
}

TEST_F(RenderThreadTest, ARendererThatFailsToStartLaterRefusesAllJobs) {
  std::promise<void> may_start;
  std::promise<Status> started;
  StartLater(
      [&may_start]() -> Result<std::unique_ptr<render::Renderer>> {
        may_start.get_future().wait();
        return kLost;
      },
      nullptr, &started);
  Submit(1);
  may_start.set_value();
  EXPECT_FALSE(started.get_future().get().ok());
  EXPECT_EQ(pictures.num_failed_tickets(), 1u);
  EXPECT_TRUE(thread->is_stuck());
  EXPECT_FALSE(thread->is_starting());
  EXPECT_EQ(thread->Preset("face").status().code(), StatusCode::kInternal);
  EXPECT_EQ(thread->fault(), "the renderer could not start");
  Submit(2);
  EXPECT_EQ(pictures.num_failed_tickets(), 2u);
}

TEST_F(RenderThreadTest, ViewersWithFlowControlSeeADraftFirst) {
  Script draft;
  draft.is_software = true;
  std::promise<void> may_start;
  std::promise<Status> started;
  StartLater(
      [this, &may_start] {
        may_start.get_future().wait();
        return Create();
      },
      [&draft] {
        return Result<std::unique_ptr<render::Renderer>>(
            std::make_unique<ScriptedRenderer>(&draft));
      },
      &started);
  Submit(1);  // without flow control, it waits for the whole character
  Submit(2, {.subscription = 2, .still = true, .acknowledges = true}, {});
  Submit(3, {.subscription = 3, .acknowledges = true}, {});
  EXPECT_EQ(pictures.Take().sequence, 3u);
  EXPECT_TRUE(thread->is_starting());
  EXPECT_EQ(draft.samples.size(), 1u);
  EXPECT_EQ(draft.streams, std::deque<std::uint64_t>{0});  // no program for completed pictures
  may_start.set_value();
  EXPECT_TRUE(started.get_future().get().ok());
  EXPECT_EQ(pictures.Take().sequence, 1u);
  EXPECT_EQ(pictures.Take().sequence, 2u);
  EXPECT_FALSE(thread->is_starting());
  EXPECT_EQ(draft.samples.size(), 1u);
  thread.reset();
  EXPECT_EQ(script.samples.size(), 2u);
}

TEST_F(RenderThreadTest, WithoutASoftwareRendererOrWithAFaultyDraftJobsWait) {
  for (const bool has_draft : {false, true}) {
    Script draft;  // of a GPU
    std::promise<void> may_start;
    std::promise<Status> started;
    StartLater(
        [this, &may_start] {
          may_start.get_future().wait();
          return Create();
        },
        [&draft, has_draft]() -> Result<std::unique_ptr<render::Renderer>> {
          if (!has_draft) return kLost;
          return std::unique_ptr<render::Renderer>(std::make_unique<ScriptedRenderer>(&draft));
        },
        &started);
    Submit(1, {.subscription = 1, .acknowledges = true}, {});
    may_start.set_value();
    EXPECT_TRUE(started.get_future().get().ok());
    EXPECT_EQ(pictures.Take().sequence, 1u);
    EXPECT_TRUE(draft.samples.empty());
    thread.reset();
  }
}

TEST_F(RenderThreadTest, ADraftThatIsLostIsNotDrawnAgain) {
  Script draft;
  draft.is_software = true;
  draft.submit = {kLost};
  std::latch in_submit(1);
  draft.in_first_submit = &in_submit;
  std::promise<void> may_start;
  std::promise<Status> started;
  StartLater(
      [this, &may_start] {
        may_start.get_future().wait();
        return Create();
      },
      [&draft] {
        return Result<std::unique_ptr<render::Renderer>>(
            std::make_unique<ScriptedRenderer>(&draft));
      },
      &started);
  Submit(1, {.subscription = 1, .acknowledges = true}, {});
  in_submit.wait();
  may_start.set_value();
  EXPECT_TRUE(started.get_future().get().ok());
  Submit(2, {.subscription = 2, .acknowledges = true}, {});
  EXPECT_EQ(pictures.Take().sequence, 2u);
  EXPECT_EQ(script.num_created, 1);
}

TEST_F(RenderThreadTest, AfterStopNothingIsDrawn) {
  Start();
  thread->Stop();
  Submit(1);
  EXPECT_EQ(pictures.num_failed_tickets(), 1u);
  EXPECT_EQ(Count(Counter::kPicturesRendered), 0u);
}

// The factory holds the character, which is large.
TEST_F(RenderThreadTest, AfterStopTheFactoryIsGone) {
  auto character = std::make_shared<int>(0);
  const std::weak_ptr<int> watched = character;
  const auto started = RenderThread::Start(
      &skeleton, [this, held = std::move(character)] { return Create(); }, &metrics, &TickingClock,
      [](FinishedPicture) {});
  ASSERT_TRUE(started.ok());
  EXPECT_FALSE((*started)->ended());
  EXPECT_FALSE(watched.expired());
  (*started)->Stop();
  while (!(*started)->ended()) std::this_thread::yield();
  EXPECT_TRUE(watched.expired());
}

TEST_F(RenderThreadTest, StartFailsWithoutARenderer) {
  script.create = {kLost};
  const auto started = RenderThread::Start(
      &skeleton, [this] { return Create(); }, &metrics, &TickingClock, [](FinishedPicture) {});
  EXPECT_EQ(started.status().code(), StatusCode::kUnavailable);
}

}  // namespace
}  // namespace furrow::server
