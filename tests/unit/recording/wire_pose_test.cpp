// SPDX-License-Identifier: Apache-2.0
#include "recording/wire_pose.h"

#include <gtest/gtest.h>

#include "protocol/codec/codec.h"

namespace furrow::recording {
namespace {

motion::Clip TwoJoints() {
  motion::Clip clip;
  auto skeleton = wrinkle::Skeleton::Create({{.name = "hips"}, {.name = "knee", .parent = 0}});
  EXPECT_TRUE(skeleton.ok());
  clip.skeleton = *skeleton;
  clip.blend_shape_names = {"jawOpen"};
  clip.times = {0.0, 0.1};
  clip.locals.resize(4);
  clip.blend_shapes = {0.0f, 0.5f};
  clip.locals[2].translation = {1.0f, 2.0f, 3.0f};
  clip.locals[3].rotation = glm::quat(0.0f, 1.0f, 0.0f, 0.0f);
  clip.locals[3].scale = glm::vec3(2.0f);
  return clip;
}

TEST(WirePoseTest, OfferAndPosesRoundTripOverTheWire) {
  const motion::Clip clip = TwoJoints();
  protocol::Encoder encoder;
  std::vector<std::uint8_t> bytes;
  protocol::MessageView view;

  encoder.Encode({.session = 1}, OfferOf(clip, "ada", 0.1f), bytes);
  protocol::SkeletonOffer offer;
  ASSERT_EQ(protocol::OpenMessage(bytes, view), protocol::DecodeStatus::kOk);
  ASSERT_EQ(protocol::Decode(view, offer), protocol::DecodeStatus::kOk);
  ASSERT_EQ(offer.joints.size(), 2u);
  EXPECT_EQ(offer.joints[1].name, "knee");
  EXPECT_EQ(offer.joints[1].parent, 0);
  EXPECT_TRUE(offer.joints[1].has_tail);
  EXPECT_FLOAT_EQ(offer.metres_per_unit, 0.1f);

  protocol::PoseFrame pose;
  FillPose(clip, 1, &pose);
  encoder.Encode({.session = 1}, pose, bytes);
  protocol::PoseFrame decoded;
  ASSERT_EQ(protocol::OpenMessage(bytes, view), protocol::DecodeStatus::kOk);
  ASSERT_EQ(protocol::Decode(view, decoded), protocol::DecodeStatus::kOk);
  EXPECT_EQ(decoded.rotation_joints, (std::vector<std::uint16_t>{0, 1}));
  EXPECT_EQ(decoded.rotations[1], (protocol::Quat{1.0f, 0.0f, 0.0f, 0.0f}));
  EXPECT_EQ(decoded.translation_joints, std::vector<std::uint16_t>{0});
  EXPECT_EQ(decoded.translations[0], (protocol::Vec3{1.0f, 2.0f, 3.0f}));
  EXPECT_EQ(decoded.scale_joints, std::vector<std::uint16_t>{1});
  EXPECT_EQ(decoded.blend_shapes, std::vector<float>{0.5f});
}

TEST(WirePoseTest, PosesHaveTheTimecodeOfTheirFrame) {
  motion::Clip clip = TwoJoints();
  clip.timecodes = {ParseTimecode("10:00:00;00", 30), std::nullopt};
  protocol::PoseFrame pose;
  FillPose(clip, 0, &pose);
  EXPECT_EQ(pose.timecode, clip.timecodes[0]);
  FillPose(clip, 1, &pose);
  EXPECT_FALSE(pose.timecode);
}

TEST(WirePoseTest, AReusedPoseDropsTheLastFrame) {
  const motion::Clip clip = TwoJoints();
  protocol::PoseFrame pose;
  FillPose(clip, 1, &pose);
  FillPose(clip, 0, &pose);
  EXPECT_TRUE(pose.translations.empty());
  EXPECT_TRUE(pose.scales.empty());
  EXPECT_EQ(pose.rotations.size(), 2u);
}

}  // namespace
}  // namespace furrow::recording
