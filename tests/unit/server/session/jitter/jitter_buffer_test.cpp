// SPDX-License-Identifier: Apache-2.0
#include "server/session/jitter/jitter_buffer.h"

#include <chrono>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr Time kDelay = milliseconds(60);
constexpr Time kStart = std::chrono::seconds(1000);
// The sender's clock has another epoch.
constexpr std::int64_t kCaptureStart = -7'000'000'000;
constexpr std::int64_t kPeriodUs = 16'667;

class JitterBufferTest : public testing::Test {
 protected:
  JitterBuffer::Place Arrive(std::uint32_t sequence, std::int64_t capture_us, Time now) {
    auto pose = std::make_unique<HeldPose>();
    pose->header = {.session = 1, .sequence = sequence, .capture_time_us = capture_us};
    const auto place = buffer_.Look(pose->header, kDelay, now, &pose->due);
    if (place == JitterBuffer::Place::kHeld) buffer_.Hold(std::move(pose));
    return place;
  }
  // The sequence of the pose that leaves at `now`; -1: none.
  std::int64_t Leave(Time now) {
    const auto pose = buffer_.TakeDue(now);
    return pose == nullptr ? -1 : static_cast<std::int64_t>(pose->header.sequence);
  }
  static std::int64_t CaptureUs(std::uint32_t pose) { return kCaptureStart + pose * kPeriodUs; }
  static Time SentAt(std::uint32_t pose) { return kStart + microseconds(pose * kPeriodUs); }

  JitterBuffer buffer_;
};

TEST_F(JitterBufferTest, PosesLeaveInOrderAtThePaceOfTheirCapture) {
  constexpr std::uint32_t kPoses = 600;
  std::mt19937 random(5);
  std::uniform_int_distribution<int> delay_us(2'000, 52'000);
  std::multimap<Time, std::uint32_t> arrivals;
  for (std::uint32_t pose = 0; pose < kPoses; ++pose) {
    arrivals.emplace(SentAt(pose) + microseconds(delay_us(random)), pose);
  }
  std::vector<Time> left(kPoses);
  std::int64_t newest = -1;
  for (Time now = kStart; now < SentAt(kPoses + 10); now += milliseconds(1)) {
    for (; !arrivals.empty() && arrivals.begin()->first <= now; arrivals.erase(arrivals.begin())) {
      const std::uint32_t pose = arrivals.begin()->second;
      EXPECT_EQ(Arrive(pose, CaptureUs(pose), now), JitterBuffer::Place::kHeld) << pose;
    }
    for (std::int64_t pose = Leave(now); pose >= 0; pose = Leave(now)) {
      EXPECT_EQ(pose, newest + 1) << "in order, and none is lost";
      newest = pose;
      left[static_cast<std::size_t>(pose)] = now;
    }
  }
  EXPECT_EQ(newest, kPoses - 1);
  // After a second, the buffer knows the shortest delay.
  for (std::size_t pose = 61; pose < kPoses; ++pose) {
    const double step_ms = ToSeconds(left[pose] - left[pose - 1]) * 1e3;
    EXPECT_NEAR(step_ms, 1e-3 * kPeriodUs, 2.0) << pose;
  }
}

TEST_F(JitterBufferTest, NoPoseWaitsLongerThanTheDelay) {
  EXPECT_EQ(Arrive(0, CaptureUs(0), kStart), JitterBuffer::Place::kHeld);
  EXPECT_EQ(Leave(kStart + kDelay - milliseconds(1)), -1);
  EXPECT_EQ(Leave(kStart + kDelay), 0);
  // A capture time far in the future, or of a sender that states none.
  EXPECT_EQ(Arrive(1, CaptureUs(100'000), kStart), JitterBuffer::Place::kHeld);
  EXPECT_EQ(Arrive(2, 0, kStart), JitterBuffer::Place::kHeld);
  EXPECT_EQ(Leave(kStart + kDelay), 1);
  EXPECT_EQ(Leave(kStart + kDelay), 2);
}

TEST_F(JitterBufferTest, LateAndDuplicatePosesAreNotHeld) {
  (void)Arrive(5, CaptureUs(5), SentAt(5));
  EXPECT_EQ(Arrive(5, CaptureUs(5), SentAt(5)), JitterBuffer::Place::kDuplicate);
  EXPECT_EQ(Arrive(4, CaptureUs(4), SentAt(5)), JitterBuffer::Place::kHeld);
  EXPECT_EQ(Leave(SentAt(5) + kDelay), 4);
  EXPECT_EQ(Leave(SentAt(5) + kDelay), 5);
  EXPECT_EQ(Arrive(3, CaptureUs(3), SentAt(9)), JitterBuffer::Place::kLate);
  EXPECT_EQ(Arrive(5, CaptureUs(5), SentAt(9)), JitterBuffer::Place::kLate);
  EXPECT_TRUE(buffer_.empty());
}

TEST_F(JitterBufferTest, SequencesWrap) {
  const std::uint32_t last = 0xFFFF'FFFF;
  (void)Arrive(0, CaptureUs(1), SentAt(1));
  (void)Arrive(last, CaptureUs(0), SentAt(1));
  EXPECT_EQ(Leave(SentAt(1) + kDelay), last);
  EXPECT_EQ(Leave(SentAt(1) + kDelay), 0);
}

TEST_F(JitterBufferTest, AClockThatIsSetBackDelaysNothingForLong) {
  for (std::uint32_t pose = 0; pose < 60; ++pose) {
    (void)Arrive(pose, CaptureUs(pose), SentAt(pose));
    while (Leave(SentAt(pose)) >= 0) {
    }
  }
  // An hour back. The next poses are held as before.
  (void)Arrive(60, CaptureUs(60) - 3'600'000'000, SentAt(60));
  const Time late = SentAt(60) + kDelay;
  while (Leave(late) >= 0) {
  }
  (void)Arrive(70, CaptureUs(70) - 3'600'000'000, SentAt(70));
  EXPECT_EQ(Leave(SentAt(70) + kDelay - milliseconds(1)), -1);
  EXPECT_EQ(Leave(SentAt(70) + kDelay), 70);
}

}  // namespace
}  // namespace furrow::server
