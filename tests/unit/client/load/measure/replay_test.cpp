// SPDX-License-Identifier: Apache-2.0
#include "client/load/measure/replay.h"

#include <gtest/gtest.h>

#include "tests/unit/client/load/workload_testing.h"

namespace furrow::load {
namespace {

constexpr float kTolerance = 1e-4f;

class ReplayTest : public testing::Test {
 protected:
  const Workload workload_ = MakePerformance();
  const Plan plan_{workload_.times, {.subjects = 1, .phases = 1, .rate = 0.0, .seconds = 4.0}};
  const ExpectedWeights expected_{workload_, plan_, [](double) { return true; }};
  Replay replay_{workload_, plan_, 0, expected_, kTolerance};

  // The weights of a server for `pose` that received all earlier poses except `lost`.
  std::vector<float> Without(std::uint32_t lost, std::uint32_t pose) const {
    wrinkle::SubjectSolver solver(workload_.binding);
    wrinkle::LocalPose local;
    std::int64_t last_us = 0;
    for (std::uint32_t i = 0; i <= pose; ++i) {
      if (i == lost) continue;
      workload_.pose(plan_.Frame(0, i), &local);
      const std::int64_t now_us = plan_.CaptureUs(0, i);
      (void)solver.Update(local, static_cast<double>(now_us - last_us) * 1e-6);
      last_us = now_us;
    }
    return {solver.wrinkle_weights().begin(), solver.wrinkle_weights().end()};
  }
  void AgreeUntil(std::uint32_t pose) {
    for (std::uint32_t i = 0; i < pose; ++i) EXPECT_LE(replay_.Agreed(i), kTolerance) << i;
  }
};

TEST_F(ReplayTest, APoseLostOnTheWayInExplainsDifferentWeights) {
  AgreeUntil(50);
  replay_.Missing(50);
  const auto values = Without(50, 51);
  EXPECT_GT(Distance(values, expected_.Row(0, 51)), kTolerance);
  const auto difference = replay_.Mismatched(51, values);
  ASSERT_TRUE(difference);
  EXPECT_LE(*difference, 1e-6f);
}

TEST_F(ReplayTest, WeightsLostOnTheWayOutExplainTheExpectedWeights) {
  AgreeUntil(50);
  replay_.Missing(50);
  EXPECT_LE(replay_.Agreed(51), 1e-6f);
  // The server received the pose, so weights without it are wrong.
  const auto difference = replay_.Mismatched(52, Without(50, 52));
  ASSERT_TRUE(difference);
  EXPECT_GT(*difference, kTolerance);
}

TEST_F(ReplayTest, NothingExplainsAnInventedNumber) {
  AgreeUntil(50);
  replay_.Missing(50);
  const auto difference = replay_.Mismatched(51, std::vector<float>{0.9f, 0.0f, 0.9f});
  ASSERT_TRUE(difference);
  EXPECT_GT(*difference, 0.1f);
}

TEST_F(ReplayTest, AfterALongGapNothingIsKnown) {
  AgreeUntil(50);
  for (std::uint32_t pose = 50; pose < 75; ++pose) replay_.Missing(pose);  // half a second
  EXPECT_FALSE(replay_.Mismatched(75, std::vector<float>{0.9f, 0.0f, 0.9f}));
}

// A replay that starts late converges to one that started with the first pose, without a gap.
TEST_F(ReplayTest, ALateStartIsForgotten) {
  Replay late(workload_, plan_, 0, expected_, kTolerance, 40);
  float difference = 1.0f;
  for (std::uint32_t pose = 40; pose < 190; ++pose) difference = late.Agreed(pose);
  EXPECT_LE(difference, 1e-6f);
  late.Missing(190);
  const auto explained = late.Mismatched(191, Without(190, 191));
  ASSERT_TRUE(explained);
  EXPECT_LE(*explained, 1e-6f);
}

}  // namespace
}  // namespace furrow::load
