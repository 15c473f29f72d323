// SPDX-License-Identifier: Apache-2.0
#include "client/cli/play/schedule.h"

#include <vector>

#include <gtest/gtest.h>

namespace furrow::cli {
namespace {

TEST(ScheduleTest, FramesKeepTheirTimesAndRoundsFollow) {
  const std::vector<double> times({5.0, 5.1, 5.4});
  const Schedule schedule(times, 0.0);
  ASSERT_EQ(schedule.count(), 3);
  const int frames[] = {0, 1, 2, 0, 1, 2, 0};
  // The last frame lasts as long as the average of the other frames, 0.4 s.
  const double seconds[] = {0.0, 0.1, 0.4, 0.6, 0.7, 1.0, 1.2};
  for (int i = 0; i < 7; ++i) {
    EXPECT_EQ(schedule.Frame(i), frames[i]) << i;
    EXPECT_NEAR(schedule.Seconds(i), seconds[i], 1e-12) << i;
  }
}

TEST(ScheduleTest, ARateSkipsAndRepeatsFrames) {
  const std::vector<double> times({0.0, 0.1, 0.2, 0.3, 0.4});
  const Schedule slow(times, 5.0);
  ASSERT_EQ(slow.count(), 3);
  const Schedule fast(times, 20.0);
  ASSERT_EQ(fast.count(), 9);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(slow.Frame(i), 2 * i);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(fast.Frame(i), i / 2);
  EXPECT_NEAR(slow.Seconds(4), 0.8, 1e-12) << "three poses of 0.2 s each, plus one";
  EXPECT_EQ(slow.Frame(4), 2);
}

TEST(ScheduleTest, ASingleFrameRepeatsAt30Hz) {
  const std::vector<double> times({2.0});
  const Schedule schedule(times, 0.0);
  EXPECT_EQ(schedule.count(), 1);
  EXPECT_EQ(schedule.Frame(7), 0);
  EXPECT_NEAR(schedule.Seconds(30), 1.0, 1e-12);
}

}  // namespace
}  // namespace furrow::cli
