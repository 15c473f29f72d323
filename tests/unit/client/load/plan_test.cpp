// SPDX-License-Identifier: Apache-2.0
#include "client/load/plan.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace furrow::load {
namespace {

TEST(Plan, SendsEachSubjectsPosesAtItsRateAndInOrder) {
  const std::vector<double> times = {0.0, 0.1, 0.2, 0.3};
  const Plan plan(times, {.subjects = 3, .phases = 2, .rate = 50.0, .seconds = 2.0});
  EXPECT_EQ(plan.slots().size(), 300u);
  EXPECT_DOUBLE_EQ(plan.poses_per_second(), 150.0);
  EXPECT_TRUE(std::ranges::is_sorted(plan.slots(), {}, &Plan::Slot::due_us));
  std::vector<std::uint32_t> next(3, 0);
  for (const Plan::Slot& slot : plan.slots()) {
    EXPECT_EQ(slot.pose, next[slot.subject]++);
    EXPECT_EQ(slot.due_us, plan.DueUs(slot.subject, slot.pose));
    EXPECT_LT(slot.due_us, 2'000'000);
  }
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(next[i], plan.count(i));
}

TEST(Plan, SubjectsDoNotSendInBursts) {
  const std::vector<double> times = {0.0, 0.1};
  const Plan plan(times, {.subjects = 100, .phases = 2, .rate = 50.0, .seconds = 1.0});
  for (std::size_t i = 1; i < plan.slots().size(); ++i)
    EXPECT_EQ(plan.slots()[i].due_us - plan.slots()[i - 1].due_us, 200);
}

TEST(Plan, KeepsTheRecordingsOwnSpacingAcrossRounds) {
  const std::vector<double> times = {5.0, 5.01, 5.05, 5.06};
  const Plan plan(times, {.subjects = 1, .phases = 1, .rate = 0.0, .seconds = 0.3});
  const std::int64_t expected[] = {0, 10'000, 50'000, 60'000, 80'000, 90'000, 130'000, 140'000};
  for (std::uint32_t pose = 0; pose < 8; ++pose) {
    EXPECT_EQ(plan.CaptureUs(0, pose), expected[pose]);
    EXPECT_EQ(plan.Frame(0, pose), static_cast<int>(pose % 4));
  }
}

TEST(Plan, PhasesBeginAtOtherFramesAndCountFromTheirOwnFirst) {
  std::vector<double> times;
  for (int i = 0; i < 60; ++i) times.push_back(i / 30.0);
  const Plan plan(times, {.subjects = 8, .phases = 4, .rate = 0.0, .seconds = 4.0});
  std::set<int> first;
  for (std::uint32_t subject = 0; subject < 8; ++subject) {
    const int phase = plan.phase_of(subject);
    first.insert(plan.Frame(phase, 0));
    EXPECT_EQ(plan.CaptureUs(phase, 0), 0);
    // Steps are the same in every round, to the microsecond.
    for (std::uint32_t pose = 1; pose < 60; ++pose) {
      EXPECT_EQ(plan.CaptureUs(phase, pose) - plan.CaptureUs(phase, pose - 1),
                plan.CaptureUs(phase, pose + 60) - plan.CaptureUs(phase, pose + 59));
    }
  }
  EXPECT_EQ(first, (std::set<int>{0, 15, 30, 45}));
}

TEST(Plan, AStillPictureIsSentSixtyTimesASecond) {
  const std::vector<double> times = {3.0};
  const Plan plan(times, {.subjects = 1, .phases = 16, .rate = 0.0, .seconds = 1.0});
  EXPECT_EQ(plan.slots().size(), 60u);
  EXPECT_EQ(plan.num_phases(), 1);
}

}  // namespace
}  // namespace furrow::load
