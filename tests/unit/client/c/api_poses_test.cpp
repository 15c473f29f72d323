// SPDX-License-Identifier: Apache-2.0
// libfurrow.so receives and publishes poses.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "api_testing.h"

namespace furrow::capi {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(CApiTest, PosesArriveWithTheirSkeleton) {
  daemon_->skeleton.subject = "bob";
  daemon_->skeleton.joints = {{.name = "neck", .rest_translation = {0, 1, 0}},
                              {.name = "head", .parent = 0, .rest_translation = {0, 0.5f, 0}}};
  daemon_->skeleton.blend_shape_names = {"jawOpen"};
  daemon_->skeleton.skeleton_hash = protocol::SkeletonHash(daemon_->skeleton);
  Connect();
  furrow_skeleton_info info{};
  info.struct_size = sizeof info;
  EXPECT_EQ(furrow_get_skeleton(c(), "ada", &info), FURROW_NOT_FOUND) << "without poses";
  furrow_subscription more{};
  more.struct_size = sizeof more;
  more.subject = "bob";
  more.flags = FURROW_SUBSCRIBE_POSES;
  ASSERT_EQ(furrow_subscribe(c(), &more), FURROW_OK);
  EXPECT_EQ(furrow_get_skeleton(c(), "bob", &info), FURROW_NO_DATA);
  ASSERT_TRUE(Polled([&] { return furrow_get_skeleton(c(), "bob", &info) == FURROW_OK; }));
  EXPECT_EQ(info.num_joints, 2u);
  EXPECT_EQ(info.num_blend_shapes, 1u);
  EXPECT_EQ(info.layout, daemon_->skeleton.skeleton_hash);
  char name[FURROW_NAME_SIZE];
  furrow_joint joint;
  EXPECT_EQ(furrow_get_joint(c(), "bob", 1, name, sizeof name, &joint), FURROW_OK);
  EXPECT_STREQ(joint.name, "head");
  EXPECT_EQ(joint.parent, 0);
  EXPECT_EQ(joint.translation[1], 0.5f);
  EXPECT_EQ(furrow_get_joint(c(), "bob", 2, name, sizeof name, nullptr), FURROW_NOT_FOUND);
  EXPECT_EQ(furrow_blend_shape_name(c(), "bob", 0, name, 8), FURROW_OK);
  EXPECT_STREQ(name, "jawOpen");
  EXPECT_EQ(furrow_blend_shape_name(c(), "bob", 0, name, 7), FURROW_BUFFER_TOO_SMALL);

  float rotations[8];
  float translations[6];
  furrow_pose_buffer buffer{};
  const auto latest = [&](std::uint32_t num_joints) {
    buffer = {sizeof buffer};
    buffer.num_joints = num_joints;
    buffer.rotations = rotations;
    buffer.translations = translations;
    return furrow_latest_pose(c(), "bob", &buffer);
  };
  EXPECT_EQ(latest(2), FURROW_NO_DATA);
  protocol::PoseFrame pose;
  pose.skeleton_hash = daemon_->skeleton.skeleton_hash;
  pose.num_joints = 2;
  pose.num_blend_shapes = 1;
  pose.rotation_joints = {1};
  pose.rotations = {{0, 1, 0, 0}};
  pose.translation_joints = {0};
  pose.translations = {{0.25f, 0, 0}};
  const auto stream = static_cast<std::uint16_t>(daemon_->requests.size());
  daemon_->Send({.stream = stream, .sequence = 7, .capture_time_us = 70}, pose);
  ASSERT_TRUE(Polled([&] { return latest(2) == FURROW_OK; }));
  EXPECT_EQ(buffer.sequence, 7u);
  EXPECT_EQ(buffer.num_blend_shapes, 1u) << "its array was not asked for";
  EXPECT_THAT(rotations, ElementsAre(0, 0, 0, 1, 0, 1, 0, 0)) << "the neck is at rest";
  EXPECT_THAT(translations, ElementsAre(0.25f, 1, 0, 0, 0.5f, 0)) << "complete, not offsets";
  EXPECT_EQ(latest(1), FURROW_BUFFER_TOO_SMALL);
  EXPECT_EQ(buffer.num_joints, 2u);
  EXPECT_EQ(furrow_unsubscribe(c(), "bob"), FURROW_OK);
  ASSERT_TRUE(Polled([&] { return daemon_->unsubscribed == 2; })) << "weights and poses";
}

TEST_F(CApiTest, SubjectsAreOfferedAndPosesSent) {
  furrow_options options{};
  options.struct_size = sizeof options;
  options.flags = FURROW_OPEN_WITHOUT_SUBSCRIPTION;
  connection_ = Open(daemon_->address(), &options);
  const furrow_joint joint{"head", -1, {0, 1, 0}, {0, 0, 0, 1}, {1, 1, 1}};
  furrow_skeleton skeleton{};
  skeleton.struct_size = sizeof skeleton;
  skeleton.joint_size = sizeof joint;
  skeleton.subject = "cleo";
  skeleton.joints = &joint;
  skeleton.num_joints = 1;
  std::uint32_t stream = 9;
  ASSERT_EQ(furrow_offer(c(), &skeleton, &stream), FURROW_OK) << LastError(c());
  EXPECT_EQ(stream, 0u);
  EXPECT_EQ(furrow_stream_status(c(), stream), FURROW_NO_DATA);
  const float rotation[4] = {0, 1, 0, 0};
  furrow_pose pose{};
  pose.struct_size = sizeof pose;
  pose.capture_time_us = 5;
  pose.rotations = rotation;
  EXPECT_EQ(furrow_send_pose(c(), stream, &pose), FURROW_NO_CONNECTION) << "not connected yet";
  ASSERT_TRUE(Polled([&] { return furrow_stream_status(c(), stream) == FURROW_OK; }));
  EXPECT_EQ(InfoOf(c()).state, FURROW_CONNECTED);
  EXPECT_EQ(InfoOf(c()).streams, 1u);
  ASSERT_EQ(furrow_send_pose(c(), stream, &pose), FURROW_OK) << LastError(c());
  ASSERT_TRUE(Polled([&] { return daemon_->poses.size() == 1; }));
  EXPECT_EQ(daemon_->offers[0].joints[0].name, "head");
  EXPECT_EQ(daemon_->poses[0].rotations[0].y, 1.0f);
  pose.flags = 8;
  EXPECT_EQ(furrow_send_pose(c(), stream, &pose), FURROW_UNSUPPORTED);
  EXPECT_EQ(furrow_send_pose(c(), 1, &pose), FURROW_UNSUPPORTED);
  pose.flags = 0;
  EXPECT_EQ(furrow_send_pose(c(), 1, &pose), FURROW_NOT_FOUND);
  EXPECT_EQ(furrow_withdraw(c(), stream), FURROW_OK);
  EXPECT_EQ(furrow_send_pose(c(), stream, &pose), FURROW_REJECTED);
  ASSERT_TRUE(Polled([&] { return daemon_->goodbyes == 1; }));
}

TEST_F(CApiTest, ARejectedRequestForPosesIsReportedAndRequestedAgain) {
  daemon_->skeleton.subject = "bob";
  daemon_->skeleton.joints = {{.name = "head"}};
  daemon_->skeleton.skeleton_hash = protocol::SkeletonHash(daemon_->skeleton);
  daemon_->reject_poses = protocol::ErrorCode::kLimit;
  Connect();
  furrow_subscription more{};
  more.struct_size = sizeof more;
  more.subject = "bob";
  more.flags = FURROW_SUBSCRIBE_POSES;
  ASSERT_EQ(furrow_subscribe(c(), &more), FURROW_OK);
  furrow_skeleton_info info{};
  info.struct_size = sizeof info;
  ASSERT_TRUE(Polled([&] { return furrow_get_skeleton(c(), "bob", &info) == FURROW_LIMIT; }));
  EXPECT_EQ(LastError(c()), "rejected by the test");
  EXPECT_EQ(furrow_layout(c(), "bob", nullptr, nullptr), FURROW_OK) << "weights go on";
  daemon_->reject_poses = {};
  ASSERT_TRUE(Polled([&] { return furrow_get_skeleton(c(), "bob", &info) == FURROW_OK; }));
  EXPECT_EQ(info.num_joints, 1u);
}

TEST_F(CApiTest, InvalidSkeletonsAreRejectedWithAReason) {
  connection_ = Open(daemon_->address());
  const char* const shapes[2] = {"jawOpen", "jawOpen"};
  furrow_skeleton skeleton{};
  skeleton.struct_size = sizeof skeleton;
  skeleton.subject = "cleo";
  skeleton.blend_shapes = shapes;
  skeleton.num_blend_shapes = 2;
  std::uint32_t stream = 9;
  EXPECT_EQ(furrow_offer(c(), &skeleton, &stream), FURROW_INVALID_ARGUMENT);
  EXPECT_THAT(LastError(c()), HasSubstr("duplicated"));
  EXPECT_EQ(stream, 9u);
  EXPECT_EQ(InfoOf(c()).streams, 0u);
}

}  // namespace
}  // namespace furrow::capi
