// SPDX-License-Identifier: Apache-2.0
#include "client/c/pose_feed.h"

#include <vector>

#include <gtest/gtest.h>

#include "protocol/messages/hash.h"

namespace furrow::capi {
namespace {

class PoseFeedTest : public testing::Test {
 protected:
  PoseFeedTest() {
    skeleton_.subject = "ada";
    skeleton_.joints = {{.name = "neck", .rest_translation = {1, 2, 3}}};
    skeleton_.blend_shape_names = {"jawOpen", "mouthClose"};
    skeleton_.skeleton_hash = protocol::SkeletonHash(skeleton_);
    pose_.skeleton_hash = skeleton_.skeleton_hash;
    pose_.num_joints = 1;
    pose_.num_blend_shapes = 2;
    pose_.blend_shape_indices = {1};
    pose_.blend_shapes = {0.5f};
  }
  bool Pose(std::uint32_t sequence, std::int64_t now_us = 0) {
    return feed_.OnPose({.sequence = sequence, .capture_time_us = sequence}, pose_, now_us);
  }

  protocol::SkeletonOffer skeleton_;
  protocol::PoseFrame pose_;
  PoseFeed feed_;
};

TEST_F(PoseFeedTest, APoseBeforeItsSkeletonIsIgnored) {
  EXPECT_FALSE(Pose(1));
  EXPECT_EQ(feed_.status(), FURROW_NO_DATA);
  feed_.OnSkeleton(skeleton_);
  EXPECT_EQ(feed_.skeleton_status(), FURROW_OK);
  EXPECT_EQ(feed_.status(), FURROW_NO_DATA);
  EXPECT_TRUE(Pose(1));
  EXPECT_EQ(feed_.status(), FURROW_OK);
}

TEST_F(PoseFeedTest, CopiesWhatIsAskedFor) {
  feed_.OnSkeleton(skeleton_);
  ASSERT_TRUE(Pose(6, 100));
  float translations[3];
  float scales[3];
  float shapes[2];
  furrow_pose_buffer buffer{};
  buffer.num_joints = 1;
  buffer.num_blend_shapes = 2;
  buffer.translations = translations;
  buffer.scales = scales;
  buffer.blend_shapes = shapes;
  EXPECT_EQ(feed_.Copy(130, &buffer), FURROW_OK);
  EXPECT_EQ(buffer.age_us, 30);
  EXPECT_EQ(buffer.number, 1u);
  EXPECT_EQ(translations[2], 3.0f) << "at rest";
  EXPECT_EQ(scales[0], 1.0f);
  EXPECT_EQ(shapes[0], 0.0f);
  EXPECT_EQ(shapes[1], 0.5f);
  buffer.num_blend_shapes = 1;
  shapes[0] = 9.0f;
  EXPECT_EQ(feed_.Copy(130, &buffer), FURROW_BUFFER_TOO_SMALL);
  EXPECT_EQ(shapes[0], 9.0f);
  EXPECT_EQ(buffer.num_blend_shapes, 2u);
}

TEST_F(PoseFeedTest, PosesOfAnotherShapeAreIgnored) {
  feed_.OnSkeleton(skeleton_);
  pose_.num_joints = 2;
  EXPECT_FALSE(Pose(1));
  pose_.num_joints = 1;
  pose_.num_blend_shapes = 1;
  EXPECT_FALSE(Pose(1));
  pose_.num_blend_shapes = 2;
  pose_.skeleton_hash ^= 1;
  EXPECT_FALSE(Pose(1));
}

TEST_F(PoseFeedTest, LatePosesAreIgnoredAndAnotherSkeletonStartsOver) {
  feed_.OnSkeleton(skeleton_);
  EXPECT_TRUE(Pose(10));
  EXPECT_FALSE(Pose(10));
  EXPECT_FALSE(Pose(9));
  EXPECT_TRUE(Pose(3, 300'000)) << "a restarted publisher";
  feed_.OnSkeleton(skeleton_);
  EXPECT_EQ(feed_.status(), FURROW_OK) << "the same skeleton again";
  skeleton_.joints[0].name = "head";
  skeleton_.skeleton_hash = protocol::SkeletonHash(skeleton_);
  feed_.OnSkeleton(skeleton_);
  EXPECT_EQ(feed_.status(), FURROW_NO_DATA);
}

TEST_F(PoseFeedTest, ARejectedRequestIsReportedAndDueAgainOnce) {
  feed_.OnError(FURROW_LIMIT, 500);
  EXPECT_EQ(feed_.status(), FURROW_LIMIT);
  EXPECT_FALSE(feed_.TakeRetry(499));
  EXPECT_TRUE(feed_.TakeRetry(500));
  EXPECT_FALSE(feed_.TakeRetry(501));
  feed_.OnError(FURROW_LIMIT, 600);
  feed_.SetSubscription(3);
  EXPECT_FALSE(feed_.TakeRetry(700)) << "the daemon has accepted it since";
  feed_.OnError(FURROW_LIMIT, 750);
  feed_.Forget();
  EXPECT_EQ(feed_.status(), FURROW_LIMIT);
  EXPECT_TRUE(feed_.TakeRetry(750)) << "also on another connection";
  feed_.OnError(FURROW_LIMIT, 800);
  feed_.OnSkeleton(skeleton_);
  EXPECT_EQ(feed_.status(), FURROW_NO_DATA);
}

}  // namespace
}  // namespace furrow::capi
