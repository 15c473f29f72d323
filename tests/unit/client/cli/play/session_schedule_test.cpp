// SPDX-License-Identifier: Apache-2.0
#include "client/cli/play/session_schedule.h"

#include <algorithm>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

namespace furrow::cli {
namespace {

using Track = SessionSchedule::Track;

const std::vector<double> kAda({0.0, 0.1, 0.2, 0.3});
const std::vector<double> kBob({7.0, 7.05, 7.1});

TEST(SessionScheduleTest, EachFrameIsDueAtItsSessionTime) {
  const std::vector<Track> tracks({{kAda, 0.0}, {kBob, 0.17}});
  SessionSchedule schedule(tracks, 0.0, 0.0);
  ASSERT_EQ(schedule.count(), 7);
  EXPECT_NEAR(schedule.duration(), 0.3, 1e-12);
  const std::vector<std::tuple<std::size_t, int, double>> expected({{0, 0, 0.0},
                                                                    {0, 1, 0.1},
                                                                    {1, 0, 0.17},
                                                                    {0, 2, 0.2},
                                                                    {1, 1, 0.22},
                                                                    {1, 2, 0.27},
                                                                    {0, 3, 0.3}});
  for (const auto& [track, frame, seconds] : expected) {
    const auto due = schedule.Next();
    ASSERT_TRUE(due);
    EXPECT_EQ(due->track, track);
    EXPECT_EQ(due->frame, frame);
    EXPECT_NEAR(due->seconds, seconds, 1e-12);
    EXPECT_EQ(due->round, 0);
  }
}

TEST(SessionScheduleTest, RoundsStartTogetherAndTimeNeverDecreases) {
  const std::vector<Track> tracks({{kAda, 0.0}, {kBob, 0.17}});
  SessionSchedule schedule(tracks, 0.0, 0.0);
  double last = 0.0;
  for (int i = 0; i < 70; ++i) {
    const auto due = schedule.Next();
    ASSERT_TRUE(due);
    EXPECT_EQ(due->round, i / 7);
    EXPECT_GE(due->seconds, last);
    last = due->seconds;
    // The four frames of ada take 0.4 s; bob ends at 0.17 + 0.15 s.
    if (i % 7 == 0) {
      EXPECT_NEAR(due->seconds, 0.4 * (i / 7), 1e-9);
    }
  }
}

TEST(SessionScheduleTest, FromSkipsTheStartOfAllTracks) {
  const std::vector<Track> tracks({{kAda, 0.0}, {kBob, 0.17}});
  SessionSchedule late(tracks, 0.0, 0.21);
  ASSERT_EQ(late.count(), 3);  // bob at 0.22 and 0.27 s, ada at 0.3 s
  EXPECT_EQ(late.Next()->track, 1u);
  EXPECT_NEAR(late.Next()->seconds, 0.05, 1e-12);
  const auto last = late.Next();
  EXPECT_EQ(last->track, 0u);
  EXPECT_EQ(last->frame, 3);
  EXPECT_NEAR(last->seconds, 0.08, 1e-12);
  SessionSchedule ada_alone(tracks, 0.0, 0.29);
  EXPECT_EQ(ada_alone.count(), 1);
  SessionSchedule over(tracks, 0.0, 0.31);
  EXPECT_EQ(over.count(), 0);
  EXPECT_FALSE(over.Next());
}

TEST(SessionScheduleTest, ASessionWithOneSubjectEqualsItsSchedule) {
  for (const double rate : {0.0, 7.0, 120.0}) {
    const std::vector<Track> tracks({{kBob, 0.0}});
    SessionSchedule session(tracks, rate, 0.0);
    const Schedule alone(kBob, rate);
    ASSERT_EQ(session.count(), alone.count());
    for (std::int64_t i = 0; i < 3 * alone.count(); ++i) {
      const auto due = session.Next();
      EXPECT_EQ(due->frame, alone.Frame(i));
      EXPECT_NEAR(due->seconds, alone.Seconds(i), 1e-12);
    }
  }
}

TEST(SessionScheduleTest, ADroppedTrackDoesNotStopTheOthers) {
  const std::vector<Track> tracks({{kAda, 0.0}, {kBob, 0.0}});
  SessionSchedule schedule(tracks, 0.0, 0.0);
  schedule.Drop(0);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(schedule.Next()->track, 1u);
  schedule.Drop(1);
  EXPECT_FALSE(schedule.Next());
}

}  // namespace
}  // namespace furrow::cli
