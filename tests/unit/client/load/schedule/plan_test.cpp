// SPDX-License-Identifier: Apache-2.0
#include "client/load/schedule/plan.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "tests/unit/client/load/workload_testing.h"

namespace furrow::load {
namespace {

TEST(Plan, PosesOfEachSubjectAreDueInOrderAtItsRate) {
  const std::vector<double> times = {0.0, 0.1, 0.2, 0.3};
  const Plan plan(times, {.subjects = 3, .phases = 2, .rate = 50.0, .seconds = 2.0});
  EXPECT_EQ(plan.num_slots(), 300u);
  EXPECT_DOUBLE_EQ(plan.poses_per_second(), 150.0);
  const auto slots = SlotsOf(plan);
  EXPECT_EQ(slots.size(), plan.num_slots());
  EXPECT_TRUE(std::ranges::is_sorted(slots, {}, &Plan::Slot::due_us));
  std::vector<std::uint32_t> next(3, 0);
  for (const Plan::Slot& slot : slots) {
    EXPECT_EQ(slot.pose, next[slot.subject]++);
    EXPECT_EQ(slot.due_us, plan.DueUs(slot.subject, slot.pose));
    EXPECT_LT(slot.due_us, 2'000'000);
  }
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(next[i], plan.count(i));
}

// The merged slots equal the sorted list of all slots.
TEST(Plan, SlotsEqualTheSortedList) {
  const std::vector<double> times = {0.0, 0.1, 0.1004, 0.1004003, 0.3};
  for (const double rate : {0.0, 30.0, 100000.0}) {
    for (const int subjects : {1, 7, 60}) {
      const PlanOptions options = {
          .subjects = subjects, .phases = 4, .rate = rate, .seconds = rate > 1e4 ? 0.01 : 2.5};
      const Plan plan(times, options);
      std::vector<Plan::Slot> sorted;
      for (std::uint32_t subject = 0; subject < static_cast<std::uint32_t>(subjects); ++subject) {
        std::uint32_t pose = 0;
        for (; plan.DueUs(subject, pose) < std::llround(options.seconds * 1e6); ++pose)
          sorted.push_back({plan.DueUs(subject, pose), subject, pose});
        EXPECT_EQ(plan.count(subject), pose);
      }
      std::ranges::stable_sort(sorted, {}, &Plan::Slot::due_us);
      const auto slots = SlotsOf(plan);
      ASSERT_EQ(slots.size(), sorted.size());
      for (std::size_t i = 0; i < slots.size(); ++i) {
        EXPECT_EQ(slots[i].due_us, sorted[i].due_us);
        EXPECT_EQ(slots[i].subject, sorted[i].subject);
        EXPECT_EQ(slots[i].pose, sorted[i].pose);
      }
    }
  }
}

TEST(Plan, ALongPlanOfManySubjectsIsCheapToCreate) {
  std::vector<double> times;
  for (int i = 0; i < 60; ++i) times.push_back(i / 60.0);
  const Plan plan(times, {.subjects = 100, .phases = 16, .rate = 0.0, .seconds = 8.0 * 3600.0});
  EXPECT_EQ(plan.num_slots(), 100u * 60u * 8u * 3600u);
  PlanSlots slots(plan);
  for (int i = 0; i < 1000; ++i) slots.Pop();
  EXPECT_EQ(slots.next().subject, 0u);
  EXPECT_EQ(slots.next().pose, 10u);
}

TEST(Plan, SubjectsDoNotSendInBursts) {
  const std::vector<double> times = {0.0, 0.1};
  const Plan plan(times, {.subjects = 100, .phases = 2, .rate = 50.0, .seconds = 1.0});
  const auto slots = SlotsOf(plan);
  for (std::size_t i = 1; i < slots.size(); ++i)
    EXPECT_EQ(slots[i].due_us - slots[i - 1].due_us, 200);
}

TEST(Plan, KeepsTheRecordedSpacingAcrossRounds) {
  const std::vector<double> times = {5.0, 5.01, 5.05, 5.06};
  const Plan plan(times, {.subjects = 1, .phases = 1, .rate = 0.0, .seconds = 0.3});
  const std::int64_t expected[] = {0, 10'000, 50'000, 60'000, 80'000, 90'000, 130'000, 140'000};
  for (std::uint32_t pose = 0; pose < 8; ++pose) {
    EXPECT_EQ(plan.CaptureUs(0, pose), expected[pose]);
    EXPECT_EQ(plan.Frame(0, pose), static_cast<int>(pose % 4));
  }
}

TEST(Plan, PhasesStartAtDifferentFramesAtCaptureTimeZero) {
  std::vector<double> times;
  for (int i = 0; i < 60; ++i) times.push_back(i / 30.0);
  const Plan plan(times, {.subjects = 8, .phases = 4, .rate = 0.0, .seconds = 4.0});
  std::set<int> first;
  for (std::uint32_t subject = 0; subject < 8; ++subject) {
    const int phase = plan.phase_of(subject);
    first.insert(plan.Frame(phase, 0));
    EXPECT_EQ(plan.CaptureUs(phase, 0), 0);
    // Capture-time steps repeat exactly in every round.
    for (std::uint32_t pose = 1; pose < 60; ++pose) {
      EXPECT_EQ(plan.CaptureUs(phase, pose) - plan.CaptureUs(phase, pose - 1),
                plan.CaptureUs(phase, pose + 60) - plan.CaptureUs(phase, pose + 59));
    }
  }
  EXPECT_EQ(first, (std::set<int>{0, 15, 30, 45}));
}

TEST(Plan, CaptureClocksJumpForwardsAndBackInTurn) {
  const std::vector<double> times = {0.0, 0.1};
  const Plan plan(times, {.subjects = 1, .seconds = 1.0, .clock_step = 2.5, .clock_every = 0.3});
  std::vector<std::int64_t> offsets;
  for (std::uint32_t pose = 0; pose < 10; ++pose) offsets.push_back(plan.ClockOffsetUs(0, pose));
  constexpr std::int64_t kOn = 2'500'000;
  EXPECT_EQ(offsets, (std::vector<std::int64_t>{0, 0, 0, kOn, kOn, kOn, 0, 0, 0, kOn}));
  const Plan steady(times, {.subjects = 1, .seconds = 1.0});
  EXPECT_EQ(steady.ClockOffsetUs(0, 9), 0);
}

TEST(Plan, ARecordingWithOneFrameIsSentAt60Hz) {
  const std::vector<double> times = {3.0};
  const Plan plan(times, {.subjects = 1, .phases = 16, .rate = 0.0, .seconds = 1.0});
  EXPECT_EQ(plan.num_slots(), 60u);
  EXPECT_EQ(plan.num_phases(), 1);
}

}  // namespace
}  // namespace furrow::load
