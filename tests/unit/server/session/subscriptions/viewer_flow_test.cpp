// SPDX-License-Identifier: Apache-2.0
#include "server/session/subscriptions/viewer_flow.h"

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

constexpr Time kFrame = FromSeconds(1.0 / 60.0);

// Requests and sends one picture. Returns its number.
std::uint32_t Show(ViewerFlow& flow, Time now) {
  EXPECT_TRUE(flow.CanRequest(now));
  flow.Request(false, now);
  return flow.Send();
}

TEST(ViewerFlow, AtMostTwoPicturesAreUnacknowledged) {
  ViewerFlow flow;
  const Time now = FromSeconds(10);
  EXPECT_EQ(Show(flow, now), 1u);
  EXPECT_EQ(Show(flow, now), 2u);
  EXPECT_FALSE(flow.CanRequest(now));
  EXPECT_TRUE(flow.Acknowledge(1));
  EXPECT_EQ(flow.under_way(), 1u);
  EXPECT_EQ(Show(flow, now), 3u);
  EXPECT_FALSE(flow.CanRequest(now));
  EXPECT_TRUE(flow.Acknowledge(3));  // acknowledges the previous one, too
  EXPECT_EQ(flow.under_way(), 0u);
}

TEST(ViewerFlow, OnePictureIsRequestedAtATime) {
  ViewerFlow flow;
  flow.Request(false, FromSeconds(1));
  EXPECT_TRUE(flow.is_pending());
  EXPECT_FALSE(flow.CanRequest(FromSeconds(9)));
  (void)flow.Send();
  EXPECT_TRUE(flow.CanRequest(FromSeconds(9)));
}

TEST(ViewerFlow, OnlySentPicturesCanBeAcknowledged) {
  ViewerFlow flow;
  EXPECT_FALSE(flow.Acknowledge(1));
  Show(flow, FromSeconds(1));
  EXPECT_FALSE(flow.Acknowledge(2));
  EXPECT_TRUE(flow.Acknowledge(1));
  Show(flow, FromSeconds(1));
  EXPECT_TRUE(flow.Acknowledge(1));  // a repetition changes nothing
  EXPECT_EQ(flow.under_way(), 1u);
}

TEST(ViewerFlow, AStillOfAnOldViewDoesNotCount) {
  ViewerFlow flow;
  const Time asked = FromSeconds(5);
  flow.Request(true, asked);
  EXPECT_TRUE(flow.HasStill(asked));
  const Time changed = asked + Time(1);  // while the still is being rendered
  EXPECT_EQ(flow.Send(), 1u);
  EXPECT_FALSE(flow.HasStill(changed));
}

TEST(ViewerFlow, APictureThatNeverComesIsRequestedAgain) {
  ViewerFlow flow;
  const Time begun = FromSeconds(100);
  flow.Request(false, begun);
  EXPECT_FALSE(flow.CanRequest(begun + ViewerFlow::kGiveUp - FromSeconds(1)));
  EXPECT_TRUE(flow.CanRequest(begun + ViewerFlow::kGiveUp));
}

TEST(ViewerFlow, AFailedPictureIsRetriedLater) {
  ViewerFlow flow;
  const Time now = FromSeconds(5);
  flow.Request(true, now);
  flow.Fail();
  EXPECT_FALSE(flow.HasStill(FromSeconds(0)));
  EXPECT_EQ(flow.under_way(), 0u);
  EXPECT_FALSE(flow.CanRequest(now + ViewerFlow::kRetry - Time(1)));
  EXPECT_TRUE(flow.CanRequest(now + ViewerFlow::kRetry));
}

// 60 poses per second for `seconds`. The viewer acknowledges at once or not at all.
void Stream(ViewerFlow& flow, double seconds, bool acknowledges, Time* now) {
  for (const Time end = *now + FromSeconds(seconds); *now < end; *now += kFrame) {
    flow.CountDue(*now);
    if (!flow.CanRequest(*now)) continue;
    const std::uint32_t number = Show(flow, *now);
    if (acknowledges) {
      EXPECT_TRUE(flow.Acknowledge(number));
    }
  }
}

TEST(ViewerFlow, AFastViewerKeepsTheBestTier) {
  ViewerFlow flow;
  Time now = FromSeconds(3);
  Stream(flow, 20, true, &now);
  EXPECT_EQ(flow.tier(), 0);
  EXPECT_EQ(flow.dropped(), 0u);
}

TEST(ViewerFlow, AStalledViewerFallsAtOnceAndRisesSlowly) {
  ViewerFlow flow;
  Time now = FromSeconds(3);
  Stream(flow, 1.5, false, &now);
  EXPECT_EQ(flow.tier(), 1);
  EXPECT_GT(flow.dropped(), 50u);
  Stream(flow, 10, false, &now);
  EXPECT_EQ(flow.tier(), ViewerFlow::kNumTiers - 1);  // the worst tier
  EXPECT_TRUE(flow.Acknowledge(2));
  Stream(flow, 3, true, &now);
  EXPECT_EQ(flow.tier(), 2);
  Stream(flow, 3.5, true, &now);
  EXPECT_EQ(flow.tier(), 1);
  Stream(flow, 5.5, true, &now);
  EXPECT_EQ(flow.tier(), 0);
}

TEST(ViewerFlow, AFailedRiseDoublesThePatience) {
  ViewerFlow flow;
  Time now = FromSeconds(3);
  double waited[2] = {0.0, 0.0};
  for (double& seconds : waited) {
    Stream(flow, 1.5, false, &now);
    ASSERT_EQ(flow.tier(), 1);
    // The viewer shows what it has received.
    for (std::uint32_t number = 1; flow.under_way() > 0; ++number) (void)flow.Acknowledge(number);
    const Time start = now;
    while (flow.tier() > 0 && now - start < FromSeconds(100)) Stream(flow, 0.5, true, &now);
    seconds = ToSeconds(now - start);
  }
  EXPECT_LT(waited[0], 10.0);  // two tiers, because the second window was half lost
  EXPECT_GT(waited[1], waited[0] + 3.0);
}

TEST(ViewerFlow, APictureThatIsTakenBackIsNotUnderWay) {
  ViewerFlow flow;
  Time now = FromSeconds(10.0);
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(flow.CanRequest(now)) << i;
    flow.Request(/*still=*/true, now);
    EXPECT_EQ(flow.Send(), 1u);
    flow.TakeBack();
    EXPECT_EQ(flow.under_way(), 0u);
    EXPECT_FALSE(flow.HasStill(Time{0})) << "the viewer has not got it";
    EXPECT_FALSE(flow.CanRequest(now)) << "not at once";
    now += ViewerFlow::kRetry;
  }
}

}  // namespace
}  // namespace furrow::server
