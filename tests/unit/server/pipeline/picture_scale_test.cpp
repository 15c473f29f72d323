// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/picture_scale.h"

#include <random>

#include <gtest/gtest.h>

#include "render/request/frame_request.h"

namespace furrow::server {
namespace {

constexpr Time kTarget = PictureScale::kTarget;

Time Times(double share, Time time) { return FromSeconds(share * ToSeconds(time)); }

// A machine on which a full picture takes `full` times the target, of which two fifths do not
// depend on the size, and which always has the next pose.
Time Draw(PictureScale* scale, double full) {
  const double s = scale->scale();
  const Time taken = Times(full * (0.4 + 0.6 * s * s), kTarget);
  scale->Observe(taken, taken);
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

TEST(PictureScale, NeverLeavesItsRange) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> load(0.1, 5.0);
  PictureScale scale;
  for (int i = 0; i < 5000; ++i) {
    const double busy = load(random);
    scale.Observe(Times(busy, kTarget), Times(busy * (1.0 + 0.1 * (i % 3)), kTarget));
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
    scale.Observe(taken, taken);
  }
  EXPECT_EQ(scale.scale(), 1.0f);
}

// The viewer asks for few pictures, or its network is slow.
TEST(PictureScale, AnIdleRendererIsNotTooSlow) {
  PictureScale scale;
  for (int i = 0; i < 300; ++i) scale.Observe(Times(2.0, kTarget), Times(4.0, kTarget));
  EXPECT_EQ(scale.scale(), 1.0f);
}

TEST(PictureScale, APauseSaysNothing) {
  PictureScale scale;
  const Time longer = PictureScale::kPause + std::chrono::milliseconds(1);
  for (int i = 0; i < 100; ++i) scale.Observe(longer, longer);
  EXPECT_EQ(scale.scale(), 1.0f);
}

// Each step up that was too slow makes the next attempt wait longer.
TEST(PictureScale, FailedAttemptsBecomeRare) {
  PictureScale scale;
  const auto pictures_until_raised = [&scale] {
    for (int i = 0; i < 3; ++i) scale.Observe(Times(1.1, kTarget), Times(1.1, kTarget));
    const float low = scale.scale();
    int pictures = 0;
    for (; scale.scale() == low; ++pictures) scale.Observe(Times(0.5, kTarget), kTarget);
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
