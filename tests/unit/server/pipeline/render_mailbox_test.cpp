// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/render_mailbox.h"

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

RenderJob Job(std::uint64_t subject, std::uint32_t sequence, std::uint64_t subscription,
              int width = 64) {
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->sequence = sequence;
  RenderJob job;
  job.subject = subject;
  job.spec.width = width;
  job.snapshot = snapshot;
  job.tickets.push_back({subscription, {}});
  return job;
}

TEST(RenderMailbox, TheNewestSnapshotWinsAndKeepsAllTickets) {
  RenderMailbox mailbox(8);
  EXPECT_EQ(mailbox.Put(Job(1, 10, 100)), RenderMailbox::PutResult::kQueued);
  EXPECT_EQ(mailbox.Put(Job(1, 11, 101)), RenderMailbox::PutResult::kReplaced);
  EXPECT_EQ(mailbox.Put(Job(1, 12, 100)), RenderMailbox::PutResult::kReplaced);
  const auto job = mailbox.Take(false);
  ASSERT_TRUE(job.has_value());
  EXPECT_EQ(job->snapshot->sequence, 12u);
  ASSERT_EQ(job->tickets.size(), 2u);
  EXPECT_EQ(job->tickets[0].subscription, 100u);
  EXPECT_EQ(job->tickets[1].subscription, 101u);
  EXPECT_FALSE(mailbox.Take(false).has_value());
}

TEST(RenderMailbox, OtherSubjectsAndSpecsWaitSeparately) {
  RenderMailbox mailbox(8);
  EXPECT_EQ(mailbox.Put(Job(1, 1, 1)), RenderMailbox::PutResult::kQueued);
  EXPECT_EQ(mailbox.Put(Job(2, 2, 2)), RenderMailbox::PutResult::kQueued);
  EXPECT_EQ(mailbox.Put(Job(1, 3, 3, 128)), RenderMailbox::PutResult::kQueued);
  EXPECT_EQ(mailbox.Take(false)->subject, 1u);
  EXPECT_EQ(mailbox.Take(false)->subject, 2u);
  EXPECT_EQ(mailbox.Take(false)->spec.width, 128);
}

TEST(RenderMailbox, AViewerThatChangesItsViewOccupiesOnePlace) {
  RenderMailbox mailbox(6);
  mailbox.Put(Job(1, 1, 200, 1000));
  mailbox.Put(Job(1, 2, 201, 1001));
  for (int width = 1; width <= 100; ++width) {
    EXPECT_EQ(mailbox.Put(Job(1, 3, 100, width)), RenderMailbox::PutResult::kQueued);
  }
  RenderJob shared = Job(1, 4, 100, 1000);
  EXPECT_EQ(mailbox.Put(std::move(shared)), RenderMailbox::PutResult::kReplaced);
  const auto first = mailbox.Take(false);
  ASSERT_EQ(first->tickets.size(), 2u);
  EXPECT_EQ(first->spec.width, 1000);
  EXPECT_EQ(mailbox.Take(false)->spec.width, 1001);
  EXPECT_FALSE(mailbox.Take(false).has_value());
}

RenderJob Still(std::uint64_t subject, std::uint32_t sequence, std::uint64_t subscription) {
  RenderJob job = Job(subject, sequence, subscription);
  job.tickets.front().still = true;
  return job;
}

TEST(RenderMailbox, ADraftServesMovingPicturesOfViewersWithFlowControl) {
  RenderMailbox mailbox(8);
  mailbox.Put(Job(1, 1, 100));  // without flow control
  RenderJob still = Still(2, 2, 200);
  still.tickets.front().acknowledges = true;
  mailbox.Put(std::move(still));
  EXPECT_FALSE(mailbox.Take(false, /*drafts=*/true).has_value());
  RenderJob moving = Job(3, 3, 300);
  moving.tickets.front().acknowledges = true;
  mailbox.Put(std::move(moving));
  EXPECT_EQ(mailbox.Take(true, /*drafts=*/true)->subject, 3u);
  EXPECT_FALSE(mailbox.Take(false, /*drafts=*/true).has_value());
  EXPECT_EQ(mailbox.Take(false)->subject, 1u);
  EXPECT_EQ(mailbox.Take(false)->subject, 2u);
}

TEST(RenderMailbox, WakeEndsOneTake) {
  RenderMailbox mailbox(8);
  mailbox.Wake();
  EXPECT_FALSE(mailbox.Take(true).has_value());
  mailbox.Put(Job(1, 1, 100));
  EXPECT_TRUE(mailbox.Take(true).has_value());
}

TEST(RenderMailbox, AStillHasHigherQualityThanItsTier) {
  PictureTicket ticket{.encoding = {render::ImageFormat::kJpeg, 45}, .tier = 2};
  EXPECT_EQ(EncodingOf(ticket).quality, 45);
  ticket.still = true;
  EXPECT_GE(EncodingOf(ticket).quality, 90);
  ticket.encoding = {render::ImageFormat::kPng, 0};
  EXPECT_EQ(EncodingOf(ticket), ticket.encoding);
}

TEST(RenderMailbox, MovementTurnsAStillIntoANormalPicture) {
  RenderMailbox mailbox(8);
  mailbox.Put(Still(1, 1, 100));
  RenderJob same = Job(1, 2, 101);
  mailbox.Put(std::move(same));
  auto job = mailbox.Take(false);
  ASSERT_TRUE(job.has_value());
  EXPECT_TRUE(job->IsStill());  // a still for one of two subscriptions
  mailbox.Put(Still(1, 3, 100));
  RenderJob moved = Job(1, 4, 0);
  moved.tickets.clear();  // only refreshes the snapshot
  moved.moved_at = FromSeconds(1);
  EXPECT_EQ(mailbox.Put(std::move(moved)), RenderMailbox::PutResult::kReplaced);
  job = mailbox.Take(false);
  ASSERT_TRUE(job.has_value());
  EXPECT_EQ(job->snapshot->sequence, 4u);
  ASSERT_EQ(job->tickets.size(), 1u);
  EXPECT_FALSE(job->IsStill());
}

TEST(RenderMailbox, MovingSubjectsGoBeforeStillsForAWhile) {
  RenderMailbox mailbox(64);
  mailbox.Put(Still(1, 0, 1));
  std::uint32_t passed = 0;
  for (std::uint32_t i = 1; i <= 20; ++i) {
    mailbox.Put(Job(2, i, 2));
    const auto job = mailbox.Take(false);
    ASSERT_TRUE(job.has_value());
    if (job->IsStill()) break;
    EXPECT_EQ(job->snapshot->sequence, i);
    ++passed;
  }
  EXPECT_EQ(passed, static_cast<std::uint32_t>(RenderMailbox::kMaxPassedOver));
}

TEST(RenderMailbox, AWaitingStillCanBeWithdrawn) {
  RenderMailbox mailbox(8);
  mailbox.Put(Still(1, 1, 100));
  mailbox.Put(Still(1, 1, 101));
  mailbox.Put(Job(2, 1, 102));
  EXPECT_TRUE(mailbox.WithdrawStill(100));
  EXPECT_FALSE(mailbox.WithdrawStill(100));
  EXPECT_FALSE(mailbox.WithdrawStill(102));  // not a still
  EXPECT_EQ(mailbox.Take(false)->subject, 2u);
  EXPECT_EQ(mailbox.Take(false)->tickets.size(), 1u);
  mailbox.Put(Still(1, 1, 100));
  EXPECT_TRUE(mailbox.WithdrawStill(100));
  EXPECT_FALSE(mailbox.Take(false).has_value());  // the job is gone, too
}

TEST(RenderMailbox, AStillThatIsBeingDrawnCanBeWithdrawn) {
  RenderMailbox mailbox(8);
  mailbox.Put(Still(1, 1, 100));
  mailbox.Put(Job(2, 1, 101));
  auto moving = mailbox.Take(false);
  auto still = mailbox.Take(false);
  EXPECT_TRUE(mailbox.IsWanted(*still));
  EXPECT_TRUE(mailbox.WithdrawStill(100));
  EXPECT_FALSE(mailbox.WithdrawStill(100));
  EXPECT_FALSE(mailbox.IsWanted(*still));
  EXPECT_EQ(mailbox.Complete(&*still), 1u);
  // A moving picture stays: its viewer would see none while it turns the camera.
  EXPECT_FALSE(mailbox.WithdrawStill(101));
  EXPECT_TRUE(mailbox.IsWanted(*moving));
}

TEST(RenderMailbox, AStillThatAnotherPictureReplacedIsNotItsAnswer) {
  RenderMailbox mailbox(8);
  mailbox.Put(Still(1, 1, 100));
  auto still = mailbox.Take(false);
  // Its viewer changes the view while it is drawn.
  EXPECT_TRUE(mailbox.WithdrawStill(100));
  mailbox.Put(Job(1, 2, 100));
  auto next = mailbox.Take(false);
  EXPECT_FALSE(mailbox.IsWanted(*still));
  EXPECT_EQ(mailbox.Complete(&*still), 1u);
  EXPECT_EQ(mailbox.Complete(&*next), 0u);
}

TEST(RenderMailbox, PreparationsComeLastAndGiveWay) {
  RenderMailbox mailbox(8);
  RenderJob preparation = Job(0, 7, 0);
  preparation.tickets.clear();
  preparation.prepares = true;
  mailbox.PutPreparation(preparation);
  EXPECT_FALSE(mailbox.Take(false).has_value()) << "only if the thread has nothing else to do";
  mailbox.Put(Job(1, 1, 100));
  EXPECT_EQ(mailbox.Take(true)->subject, 1u);
  auto taken = mailbox.Take(true);
  ASSERT_TRUE(taken->prepares);
  EXPECT_TRUE(mailbox.IsWanted(*taken));
  mailbox.Put(Job(2, 1, 100));
  EXPECT_FALSE(mailbox.IsWanted(*taken));
  mailbox.PutPreparation(*std::move(taken), /*first=*/true);
  EXPECT_EQ(mailbox.Take(true)->subject, 2u);
  EXPECT_TRUE(mailbox.Take(true)->prepares);
  mailbox.PutPreparation(preparation);
  mailbox.Close();
  EXPECT_FALSE(mailbox.Take(true).has_value());
  EXPECT_FALSE(mailbox.IsWanted(preparation));
}

// A job of a viewer at a host; the subscription has the viewer's number.
RenderJob JobOf(std::uint64_t host, std::uint64_t viewer, int width = 64) {
  RenderJob job = Job(/*subject=*/1, 1, viewer, width);
  job.tickets.front().host = host;
  job.tickets.front().viewer = viewer;
  return job;
}

TEST(RenderMailbox, IsBoundedAndSharedBetweenHosts) {
  RenderMailbox mailbox(8);
  int taken = 0;
  for (std::uint64_t viewer = 1; viewer <= 8; ++viewer) {
    const auto result = mailbox.Put(JobOf(1, viewer, 100 + static_cast<int>(viewer)));
    taken += result == RenderMailbox::PutResult::kQueued ? 1 : 0;
  }
  EXPECT_EQ(taken, 4) << "one host gets half";
  EXPECT_EQ(mailbox.Put(JobOf(2, 20, 200)), RenderMailbox::PutResult::kQueued);
  EXPECT_EQ(mailbox.Put(JobOf(2, 20, 200)), RenderMailbox::PutResult::kReplaced);
}

TEST(RenderMailbox, LargePicturesDoNotDelayThoseOfOtherHosts) {
  RenderMailbox mailbox(64);
  // Host 1 has eight viewers of large pictures; host 2 asks for a small one at a time.
  int small = 0;
  for (int round = 0; round < 20; ++round) {
    for (std::uint64_t viewer = 1; viewer <= 8; ++viewer) {
      mailbox.Put(JobOf(1, viewer, 1024 + static_cast<int>(viewer)));
    }
    mailbox.Put(JobOf(2, 20, 64));
    auto job = mailbox.Take(false);
    ASSERT_TRUE(job.has_value());
    small += job->tickets.front().host == 2 ? 1 : 0;
    mailbox.Complete(&*job);
  }
  EXPECT_GE(small, 16) << "of 20, although the large ones came first";
}

TEST(RenderMailbox, ViewersOfAHostTakeTurns) {
  RenderMailbox mailbox(64);
  for (int width = 100; width < 110; ++width) {
    RenderJob job = JobOf(1, 7, width);
    job.tickets.front().subscription = static_cast<std::uint64_t>(width);
    mailbox.Put(std::move(job));
  }
  mailbox.Put(JobOf(1, 8, 120));
  EXPECT_EQ(mailbox.Take(false)->tickets.front().viewer, 7u);
  EXPECT_EQ(mailbox.Take(false)->tickets.front().viewer, 8u) << "not behind ten others";
}

// As requests for single pictures from one host do: each is a viewer of its own.
TEST(RenderMailbox, ASmallPictureDoesNotWaitForAllLargeOnesOfItsHost) {
  RenderMailbox mailbox(64);
  for (std::uint64_t viewer = 1; viewer <= 8; ++viewer) {
    mailbox.Put(JobOf(1, viewer, 1024 + static_cast<int>(viewer)));
  }
  EXPECT_NE(mailbox.Take(false)->tickets.front().viewer, 20u);
  mailbox.Put(JobOf(1, 20, 64));
  EXPECT_EQ(mailbox.Take(false)->tickets.front().viewer, 20u);
  EXPECT_NE(mailbox.Take(false)->tickets.front().viewer, 20u);
}

// Set by each test that uses it.
std::atomic<Time> clock_time{std::chrono::seconds(100)};
Time ClockTime() { return clock_time; }

TEST(RenderMailbox, AHostBeyondItsBudgetWaits) {
  clock_time = std::chrono::seconds(100);
  RenderMailbox mailbox(64);
  const double work = JobOf(1, 7, 512).Work();
  mailbox.SetBudget({.host = work}, &ClockTime);
  mailbox.Put(JobOf(1, 7, 512));
  EXPECT_FALSE(mailbox.Take(false)->was_held);
  mailbox.Put(JobOf(1, 7, 512));
  EXPECT_FALSE(mailbox.Take(false)->was_held) << "the first was saved up";
  mailbox.Put(JobOf(1, 7, 512));
  EXPECT_FALSE(mailbox.Take(false).has_value());
  mailbox.Put(JobOf(2, 20, 256));
  EXPECT_EQ(mailbox.Take(false)->tickets.front().host, 2u) << "another host does not";
  EXPECT_FALSE(mailbox.Take(false).has_value());
  mailbox.Put(JobOf(1, 7, 512));  // a newer pose
  clock_time = std::chrono::seconds(101);
  EXPECT_TRUE(mailbox.Take(false)->was_held);
}

TEST(RenderMailbox, APictureForSeveralHostsComesWhenOneMayBeServed) {
  clock_time = std::chrono::seconds(100);
  RenderMailbox mailbox(64);
  mailbox.SetBudget({.host = 1.0}, &ClockTime);
  mailbox.Put(JobOf(1, 7, 512));
  EXPECT_TRUE(mailbox.Take(false).has_value());
  RenderJob shared = JobOf(1, 7, 512);
  shared.tickets.push_back(JobOf(2, 20, 512).tickets.front());
  shared.tickets.back().subscription = 20;
  mailbox.Put(std::move(shared));
  EXPECT_EQ(mailbox.Take(false)->tickets.size(), 2u);
}

TEST(RenderMailbox, PreparationsGoOnWhileAHostWaits) {
  clock_time = std::chrono::seconds(100);
  RenderMailbox mailbox(64);
  mailbox.SetBudget({.host = 1.0}, &ClockTime);
  mailbox.Put(JobOf(1, 7, 512));
  EXPECT_TRUE(mailbox.Take(false).has_value());
  mailbox.Put(JobOf(1, 7, 512));
  RenderJob preparation = JobOf(0, 0, 96);
  preparation.tickets.clear();
  preparation.prepares = true;
  mailbox.PutPreparation(std::move(preparation));
  const auto taken = mailbox.Take(/*wait=*/true);
  ASSERT_TRUE(taken.has_value());
  EXPECT_TRUE(taken->prepares);
  EXPECT_TRUE(mailbox.IsWanted(*taken));
  clock_time = std::chrono::hours(2);
  EXPECT_FALSE(mailbox.IsWanted(*taken)) << "the host may be served";
}

TEST(RenderMailbox, TakeWaitsUntilTheHostMayBeServed) {
  RenderMailbox mailbox(64);
  clock_time = std::chrono::seconds(100);
  // Each look at the clock takes 10 ms.
  const RenderMailbox::Clock clock = [] {
    return clock_time = clock_time.load() + std::chrono::milliseconds(10);
  };
  mailbox.SetBudget({.host = JobOf(1, 7, 512).Work() / 1.1}, clock);
  mailbox.Put(JobOf(1, 7, 512));
  EXPECT_FALSE(mailbox.Take(/*wait=*/true)->was_held);
  mailbox.Put(JobOf(1, 7, 512));
  EXPECT_TRUE(mailbox.Take(/*wait=*/true)->was_held);
  EXPECT_GE(clock_time.load(), std::chrono::milliseconds(100'100));
}

TEST(RenderMailbox, WhatNobodyWantsAnyMoreIsNotDrawn) {
  RenderMailbox mailbox(8);
  mailbox.Put(Job(1, 1, 100));
  mailbox.Put(Job(1, 1, 101));
  mailbox.Put(Job(1, 1, 102, 128));
  EXPECT_EQ(mailbox.Withdraw(102), 1u);
  EXPECT_EQ(mailbox.Withdraw(100), 0u) << "another viewer wants the same picture";
  auto job = mailbox.Take(false);
  ASSERT_TRUE(job.has_value());
  EXPECT_EQ(job->tickets.size(), 1u);
  EXPECT_FALSE(mailbox.Take(false).has_value());
  // Drawing has begun; encoding has not.
  EXPECT_EQ(mailbox.Withdraw(101), 1u);
  EXPECT_EQ(mailbox.Complete(&*job), 1u);
  EXPECT_TRUE(job->tickets.empty());
}

TEST(RenderMailbox, AJobInTwoPicturesIsCompletedTwice) {
  RenderMailbox mailbox(8);
  mailbox.Put(Job(1, 1, 100));
  auto first = mailbox.Take(false);
  mailbox.Put(Job(1, 2, 100));
  auto second = mailbox.Take(false);
  EXPECT_EQ(mailbox.Complete(&*first), 0u);
  EXPECT_EQ(mailbox.Complete(&*second), 0u);
  EXPECT_EQ(mailbox.Withdraw(100), 0u);
}

TEST(RenderMailbox, AllWaitingJobsCanBeTakenBack) {
  RenderMailbox mailbox(8);
  mailbox.Put(Job(1, 1, 1));
  mailbox.Put(Still(2, 1, 2));
  EXPECT_EQ(mailbox.TakeWaiting().size(), 2u);
  EXPECT_FALSE(mailbox.Take(false).has_value());
}

TEST(RenderMailbox, ClosingWakesTake) {
  RenderMailbox mailbox(2);
  std::thread taker([&] { EXPECT_FALSE(mailbox.Take(true).has_value()); });
  mailbox.Close();
  taker.join();
  EXPECT_TRUE(mailbox.closed());
  EXPECT_EQ(mailbox.Put(Job(1, 1, 1)), RenderMailbox::PutResult::kFull);
}

TEST(RenderMailbox, AJobPutByAnotherThreadIsTaken) {
  RenderMailbox mailbox(2);
  std::thread putter(
      [&] { EXPECT_EQ(mailbox.Put(Job(1, 7, 1)), RenderMailbox::PutResult::kQueued); });
  const auto job = mailbox.Take(true);
  putter.join();
  ASSERT_TRUE(job.has_value());
  EXPECT_EQ(job->snapshot->sequence, 7u);
}

}  // namespace
}  // namespace furrow::server
