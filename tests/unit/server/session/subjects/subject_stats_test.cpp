// SPDX-License-Identifier: Apache-2.0
#include "server/session/subjects/subject_stats.h"

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

class SubjectStatsTest : public testing::Test {
 protected:
  // Poses of 60 Hz for so long, sent at `speed`, every second one late by so much.
  void Stream(double seconds, double speed = 1.0, double late_seconds = 0.0) {
    const Time begin = now;
    const int count = static_cast<int>(seconds * 60.0 * speed);
    for (int i = 0; i < count; ++i) {
      now = begin + FromSeconds(i / (60.0 * speed) + (i % 2 == 1 ? late_seconds : 0.0));
      capture_us += 16'667;
      stats.OnPose(sequence++, capture_us, now);
    }
    now = begin + FromSeconds(seconds);
  }
  // The last pose ten times a second.
  void Repeat(double seconds) {
    for (const Time end = now + FromSeconds(seconds); now < end; now += FromSeconds(0.1)) {
      stats.OnPose(sequence++, capture_us, now);
    }
  }

  SubjectStats stats;
  std::uint32_t sequence = 0;
  std::int64_t capture_us = 1;
  Time now = FromSeconds(100);
};

TEST_F(SubjectStatsTest, AnEvenStreamHasNoJitter) {
  EXPECT_EQ(stats.rate_hz(now), 0.0);
  Stream(3.0);
  EXPECT_NEAR(stats.rate_hz(now), 60.0, 1.0);
  EXPECT_LT(stats.jitter_seconds(now), 1e-4);
  EXPECT_EQ(stats.lost(), 0u);
}

TEST_F(SubjectStatsTest, AnUnevenStreamHasJitter) {
  Stream(3.0, 1.0, 0.004);  // early by 4 ms, late by 4 ms, in turn
  EXPECT_NEAR(stats.jitter_seconds(now), 0.004, 0.0005);
}

TEST_F(SubjectStatsTest, SlowMotionHasNoJitter) {
  Stream(3.0, 0.25);
  EXPECT_NEAR(stats.rate_hz(now), 15.0, 0.5);
  EXPECT_LT(stats.jitter_seconds(now), 1e-4);
}

TEST_F(SubjectStatsTest, ASilentStreamHasNoRate) {
  Stream(3.0, 1.0, 0.004);
  now += FromSeconds(1.0);
  EXPECT_EQ(stats.rate_hz(now), 0.0);
  EXPECT_EQ(stats.jitter_seconds(now), 0.0);
}

TEST_F(SubjectStatsTest, RepeatedPosesCountAsPosesOnly) {
  Stream(3.0);
  const std::uint64_t streamed = stats.poses();
  Repeat(5.0);
  EXPECT_GT(stats.poses(), streamed + 40);
  EXPECT_EQ(stats.rate_hz(now), 0.0);
  EXPECT_EQ(stats.jitter_seconds(now), 0.0);
  Stream(2.0);
  EXPECT_NEAR(stats.rate_hz(now), 60.0, 1.0);
  EXPECT_LT(stats.jitter_seconds(now), 1e-4);  // the pause was none
  EXPECT_EQ(stats.lost(), 0u);
}

TEST_F(SubjectStatsTest, AJumpInTheTimelineIsNotJitter) {
  Stream(2.0);
  capture_us += 30'000'000;
  Stream(0.5);
  EXPECT_LT(stats.jitter_seconds(now), 1e-4);
  capture_us -= 25'000'000;
  Stream(0.5);
  EXPECT_LT(stats.jitter_seconds(now), 1e-4);
}

TEST_F(SubjectStatsTest, PosesWithoutCaptureTimesHaveNoJitter) {
  for (int i = 0; i < 180; ++i, now += FromSeconds(1.0 / 60.0)) {
    stats.OnPose(sequence++, 0, now);
  }
  EXPECT_NEAR(stats.rate_hz(now), 60.0, 1.0);
  EXPECT_EQ(stats.jitter_seconds(now), 0.0);
}

TEST_F(SubjectStatsTest, GapsAreLossesAndRestartsAreNot) {
  Stream(0.5);
  sequence += 3;
  Stream(0.5);
  EXPECT_EQ(stats.lost(), 3u);
  sequence = 0;
  Stream(0.5);
  EXPECT_EQ(stats.lost(), 3u);
}

}  // namespace
}  // namespace furrow::server
