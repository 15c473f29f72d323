// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/picture_scale.h"

#include <random>

#include <gtest/gtest.h>

#include "render/request/frame_request.h"

namespace furrow::server {
namespace {

constexpr Time kTarget = PictureScale::kTarget;

Time Times(double share, Time time) { return FromSeconds(share * ToSeconds(time)); }

// The renderer works for one stream alone.
void See(PictureScale* scale, Time busy, Time passed) {
  scale->Observe({.own = busy, .busy = busy, .passed = passed});
}

// A machine on which a full picture takes `full` times the target, of which two fifths do not
// depend on the size, and which always has the next pose.
Time Draw(PictureScale* scale, double full) {
  const double s = scale->scale();
  const Time taken = Times(full * (0.4 + 0.6 * s * s), kTarget);
  See(scale, taken, taken);
  return taken;
}

TEST(PictureScale, AFastMachineDrawsInFull) {
  PictureScale scale;
  for (int i = 0; i < 500; ++i) (void)Draw(&scale, 0.9);
  EXPECT_EQ(scale.scale(), 1.0f);
}

TEST(PictureScale, ASlowMachineReachesTheTargetWithinASecond) {
  PictureScale scale;
  Time passed{0};
  while (passed < std::chrono::seconds(1)) passed += Draw(&scale, 1.6);
  EXPECT_LE(Draw(&scale, 1.6), Times(1.05, kTarget));
  EXPECT_GT(scale.scale(), render::kMinScale);
}

// Sizes in between would cost more than the full one.
TEST(PictureScale, TheFirstStepSavesMoreThanCompletingCosts) {
  PictureScale scale;
  for (int i = 0; i < 3; ++i) See(&scale, Times(1.1, kTarget), Times(1.1, kTarget));
  EXPECT_EQ(scale.scale(), 0.75f);
}

TEST(PictureScale, NeverLeavesItsRange) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> load(0.1, 5.0);
  PictureScale scale;
  for (int i = 0; i < 5000; ++i) {
    const double busy = load(random);
    See(&scale, Times(busy, kTarget), Times(busy * (1.0 + 0.1 * (i % 3)), kTarget));
    ASSERT_GE(scale.scale(), render::kMinScale);
    ASSERT_LE(scale.scale(), 1.0f);
  }
}

TEST(PictureScale, ComesToRest) {
  for (const double full : {0.7, 0.9, 1.1, 1.3, 1.5, 1.8, 2.5}) {
    PictureScale scale;
    for (int i = 0; i < 2000; ++i) (void)Draw(&scale, full);
    int changes = 0;
    for (int i = 0; i < 1000; ++i) {
      const float before = scale.scale();
      (void)Draw(&scale, full);
      changes += scale.scale() != before ? 1 : 0;
    }
    EXPECT_LE(changes, 6) << full;
  }
}

TEST(PictureScale, RisesAgainWhenTheMachineIsFree) {
  PictureScale scale;
  for (int i = 0; i < 100; ++i) (void)Draw(&scale, 2.5);
  EXPECT_EQ(scale.scale(), render::kMinScale);
  for (int i = 0; i < 1000; ++i) (void)Draw(&scale, 0.5);
  EXPECT_EQ(scale.scale(), 1.0f);
}

TEST(PictureScale, SingleSlowPicturesChangeNothing) {
  PictureScale scale;
  for (int i = 0; i < 300; ++i) {
    const Time taken = Times(i % 3 == 0 ? 3.0 : 0.9, kTarget);
    See(&scale, taken, taken);
  }
  EXPECT_EQ(scale.scale(), 1.0f);
}

// The viewer asks for few pictures, or its network is slow.
TEST(PictureScale, AnIdleRendererIsNotTooSlow) {
  PictureScale scale;
  for (int i = 0; i < 300; ++i) See(&scale, Times(2.0, kTarget), Times(4.0, kTarget));
  EXPECT_EQ(scale.scale(), 1.0f);
}

TEST(PictureScale, APauseSaysNothing) {
  PictureScale scale;
  for (int i = 0; i < 3; ++i) See(&scale, 2 * kTarget, 2 * kTarget);
  const float low = scale.scale();
  ASSERT_LT(low, 1.0f);
  for (int i = 0; i < 100; ++i) {
    See(&scale, Time(0), PictureScale::kPause + std::chrono::milliseconds(1));
  }
  EXPECT_EQ(scale.scale(), low);
}

TEST(PictureScale, ARendererThatWorksForSecondsDoesNotPause) {
  PictureScale scale;
  const Time taken = 2 * PictureScale::kPause;
  for (int i = 0; i < 20; ++i) See(&scale, taken, taken);
  EXPECT_EQ(scale.scale(), render::kMinScale);
}

// The viewer waits a little for each picture, such as for the network.
TEST(PictureScale, AShortWaitBetweenSlowPicturesDoesNotHideThem) {
  PictureScale scale;
  for (int i = 0; i < 20; ++i) See(&scale, 2 * kTarget, Times(2.5, kTarget));
  EXPECT_LT(scale.scale(), 1.0f);
}

// A small picture once per second, beside a stream that takes all of the renderer's time.
TEST(PictureScale, OnlyTheStreamWithMostOfTheWorkGetsSmaller) {
  PictureScale small;
  PictureScale large;
  for (int i = 0; i < 100; ++i) {
    const Time second = std::chrono::seconds(1);
    small.Observe({.own = kTarget / 8, .busy = second, .passed = second, .num_streams = 2});
    large.Observe({.own = 2 * kTarget, .busy = 2 * kTarget, .passed = 2 * kTarget});
  }
  EXPECT_EQ(small.scale(), 1.0f);
  EXPECT_EQ(large.scale(), render::kMinScale);
}

TEST(PictureScale, AStreamWithLittleWorkRisesBesideABusyOne) {
  PictureScale scale;
  for (int i = 0; i < 20; ++i) See(&scale, 2 * kTarget, 2 * kTarget);
  ASSERT_EQ(scale.scale(), render::kMinScale);
  const Time second = std::chrono::seconds(1);
  for (int i = 0; i < 1000; ++i) {
    scale.Observe({.own = kTarget / 8, .busy = second, .passed = second, .num_streams = 2});
  }
  EXPECT_EQ(scale.scale(), 1.0f);
}

// Each step up that was too slow makes the next attempt wait longer.
TEST(PictureScale, FailedAttemptsBecomeRare) {
  PictureScale scale;
  const auto pictures_until_raised = [&scale] {
    for (int i = 0; i < 3; ++i) See(&scale, Times(1.1, kTarget), Times(1.1, kTarget));
    const float low = scale.scale();
    int pictures = 0;
    for (; scale.scale() == low; ++pictures) See(&scale, Times(0.5, kTarget), kTarget);
    return pictures;
  };
  const int first = pictures_until_raised();
  const int second = pictures_until_raised();
  const int third = pictures_until_raised();
  EXPECT_EQ(second, 2 * first);
  EXPECT_EQ(third, 4 * first);
}

}  // namespace
}  // namespace furrow::server
