// SPDX-License-Identifier: Apache-2.0
#include "client/c/pose_input.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::capi {
namespace {

using testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class PoseInputTest : public testing::Test {
 protected:
  PoseInputTest() {
    joints_ = {{"neck", -1, {0, 1.5f, 0}, {0, 0, 0, 1}, {0, 0, 0}},
               {"head", 0, {0, 0.25f, 0}, {0, 0, 0, 2}, {1, 2, 1}}};
    skeleton_.struct_size = sizeof skeleton_;
    skeleton_.joint_size = sizeof(furrow_joint);
    skeleton_.subject = "ada";
    skeleton_.joints = joints_.data();
    skeleton_.num_joints = 2;
    skeleton_.num_blend_shapes = 1;
    skeleton_.blend_shapes = shapes_;
    pose_.struct_size = sizeof pose_;
  }
  std::string Problem() {
    const auto offer = ReadSkeleton(skeleton_);
    return offer.ok() ? "" : offer.status().ToString();
  }
  Status Read(protocol::PoseFrame* pose) {
    const auto offer = ReadSkeleton(skeleton_);
    EXPECT_TRUE(offer.ok()) << offer.status().ToString();
    return PoseReader(*offer).Read(pose_, pose);
  }

  std::vector<furrow_joint> joints_;
  const char* shapes_[1] = {"jawOpen"};
  furrow_skeleton skeleton_{};
  furrow_pose pose_{};
};

TEST_F(PoseInputTest, ReadsASkeleton) {
  const auto offer = ReadSkeleton(skeleton_);
  ASSERT_TRUE(offer.ok()) << offer.status().ToString();
  EXPECT_EQ(offer->subject, "ada");
  EXPECT_EQ(offer->metres_per_unit, 1.0f);
  ASSERT_EQ(offer->joints.size(), 2u);
  EXPECT_EQ(offer->joints[0].rest_scale, (protocol::Vec3{1, 1, 1})) << "0 means 1";
  EXPECT_EQ(offer->joints[1].rest_scale, (protocol::Vec3{1, 2, 1}));
  EXPECT_EQ(offer->joints[1].rest_rotation, (protocol::Quat{0, 0, 0, 1})) << "made a unit";
  EXPECT_EQ(offer->joints[1].parent, 0);
  EXPECT_EQ(offer->blend_shape_names, std::vector<std::string>{"jawOpen"});
}

TEST_F(PoseInputTest, EveryInvalidFieldOfASkeletonIsNamed) {
  const auto skeleton = skeleton_;
  const auto joints = joints_;
  const auto expect = [&](const char* text, const auto& change) {
    skeleton_ = skeleton;
    joints_ = joints;
    skeleton_.joints = joints_.data();
    change();
    EXPECT_THAT(Problem(), HasSubstr(text));
  };
  expect("subject", [&] { skeleton_.subject = nullptr; });
  expect("subject", [&] { skeleton_.subject = ""; });
  expect("subject", [&] { skeleton_.subject = "a\nb"; });
  expect("subject", [&] { skeleton_.subject = "\xff"; });
  const std::string long_name(256, 'a');
  expect("subject", [&] { skeleton_.subject = long_name.c_str(); });
  expect("joints is null", [&] { skeleton_.joints = nullptr; });
  expect("joint_size", [&] { skeleton_.joint_size = 0; });
  expect("joint_size", [&] { skeleton_.joint_size = 1u << 20; });
  expect("too many", [&] { skeleton_.num_joints = 1025; });
  expect("too many", [&] { skeleton_.num_blend_shapes = 513; });
  expect("neither", [&] { skeleton_.num_joints = skeleton_.num_blend_shapes = 0; });
  expect("blend_shapes is null", [&] { skeleton_.blend_shapes = nullptr; });
  expect("metres_per_unit", [&] { skeleton_.metres_per_unit = -1.0f; });
  expect("metres_per_unit", [&] { skeleton_.metres_per_unit = kNan; });
  expect("reserved", [&] { skeleton_.reserved = 1; });
  expect("joint 1", [&] { joints_[1].name = nullptr; });
  expect("parent", [&] { joints_[1].parent = 1; });
  expect("parent", [&] { joints_[1].parent = -2; });
  expect("translation or scale", [&] { joints_[1].translation[2] = kNan; });
  expect("translation or scale", [&] { joints_[1].scale[0] = 2e6f; });
  expect("rotation of length 0", [&] { std::memset(joints_[0].rotation, 0, 16); });
  expect("rotation of length 0", [&] { joints_[0].rotation[3] = INFINITY; });
  shapes_[0] = nullptr;
  expect("blend shape 0", [] {});
}

TEST_F(PoseInputTest, JointsOfANewerProgramAreReadWithTheirStride) {
  struct NewJoint {
    furrow_joint joint;
    std::uint64_t more;
  };
  std::vector<NewJoint> joints = {{joints_[0], 0}, {joints_[1], 0}};
  skeleton_.joints = &joints[0].joint;
  skeleton_.joint_size = sizeof(NewJoint);
  EXPECT_EQ(Problem(), "");
  EXPECT_EQ(ReadSkeleton(skeleton_)->joints[1].name, "head");
  joints[1].more = 1;
  EXPECT_THAT(Problem(), HasSubstr("does not know"));
}

TEST_F(PoseInputTest, TranslationsBecomeOffsetsAndRotationsUnits) {
  const float rotations[8] = {0, 0, 0, 3, 0, 4, 0, 3};
  const float translations[6] = {0, 1.5f, 0.5f, 0, 0.25f, 0};
  const float scales[6] = {1, 1, 1, 2, 2, 2};
  const float shapes[1] = {0.75f};
  pose_.rotations = rotations;
  pose_.translations = translations;
  pose_.scales = scales;
  pose_.blend_shapes = shapes;
  protocol::PoseFrame pose;
  const Status status = Read(&pose);
  ASSERT_TRUE(status.ok()) << status.ToString();
  EXPECT_EQ(pose.num_joints, 2);
  EXPECT_EQ(pose.num_blend_shapes, 1);
  EXPECT_EQ(pose.rotation_joints, (std::vector<std::uint16_t>{0, 1}));
  EXPECT_EQ(pose.rotations[0], (protocol::Quat{0, 0, 0, 1}));
  EXPECT_FLOAT_EQ(pose.rotations[1].y, 0.8f);
  EXPECT_FLOAT_EQ(pose.rotations[1].w, 0.6f);
  EXPECT_EQ(pose.translations[0], (protocol::Vec3{0, 0, 0.5f}));
  EXPECT_EQ(pose.translations[1], (protocol::Vec3{0, 0, 0}));
  EXPECT_EQ(pose.scales[1], (protocol::Vec3{2, 2, 2}));
  EXPECT_EQ(pose.blend_shapes, std::vector{0.75f});
}

TEST_F(PoseInputTest, APoseWithoutArraysIsAtRest) {
  protocol::PoseFrame pose;
  ASSERT_TRUE(Read(&pose).ok());
  EXPECT_TRUE(pose.rotations.empty());
  EXPECT_TRUE(pose.translations.empty());
  EXPECT_TRUE(pose.blend_shapes.empty());
}

TEST_F(PoseInputTest, NumbersThatAreNoneAreRejected) {
  for (const float bad : {kNan, INFINITY, -INFINITY, 2e6f}) {
    protocol::PoseFrame pose;
    const float rotations[8] = {0, 0, 0, 1, 0, bad, 0, 1};
    const float translations[6] = {0, 0, 0, 0, bad, 0};
    const float scales[6] = {1, 1, 1, 1, 1, bad};
    for (const float* const* field :
         {&pose_.rotations, &pose_.translations, &pose_.scales, &pose_.blend_shapes}) {
      pose_ = {};
      const_cast<const float*&>(*field) = field == &pose_.rotations      ? rotations
                                          : field == &pose_.translations ? translations
                                          : field == &pose_.scales       ? scales
                                                                         : &bad;
      EXPECT_FALSE(Read(&pose).ok());
    }
  }
  pose_ = {};
  protocol::PoseFrame pose;
  const float zero[8] = {};
  pose_.rotations = zero;
  EXPECT_THAT(Read(&pose).ToString(), HasSubstr("rotation 0"));
  pose_ = {};
  pose_.capture_time_us = std::numeric_limits<std::int64_t>::max();
  EXPECT_THAT(Read(&pose).ToString(), HasSubstr("capture_time_us"));
}

}  // namespace
}  // namespace furrow::capi
