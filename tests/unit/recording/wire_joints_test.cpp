// SPDX-License-Identifier: Apache-2.0
#include "recording/wire_joints.h"

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::recording {
namespace {

using testing::ElementsAre;

// The skeleton has the joints of the offer in reverse order.
class WireJoints : public testing::Test {
 protected:
  void Apply(const protocol::PoseFrame& frame, float scale = 1.0f) {
    ApplyWirePose(frame, {rest_, joint_of_wire_, scale}, joints_, blend_shapes_);
  }

  const std::array<wrinkle::Transform, 2> rest_{
      wrinkle::Transform{.translation = {0.0f, 1.0f, 0.0f}},
      wrinkle::Transform{.translation = {0.0f, 2.0f, 0.0f}}};
  const std::array<std::int16_t, 2> joint_of_wire_{1, 0};
  std::array<wrinkle::Transform, 2> joints_;
  std::array<float, 3> blend_shapes_{1.0f, 2.0f, 3.0f};
};

TEST_F(WireJoints, ValuesGoToTheJointsOfTheSkeleton) {
  protocol::PoseFrame frame;
  frame.rotation_joints = {0};
  frame.rotations = {{1.0f, 0.0f, 0.0f, 0.0f}};
  frame.translation_joints = {1};
  frame.translations = {{3.0f, 0.0f, 0.0f}};
  frame.scales = {{2.0f, 2.0f, 2.0f}, {4.0f, 4.0f, 4.0f}};  // of all joints
  frame.blend_shape_indices = {2};
  frame.blend_shapes = {0.5f};
  Apply(frame, 0.1f);
  EXPECT_EQ(joints_[1].rotation, glm::quat(0.0f, 1.0f, 0.0f, 0.0f));
  EXPECT_EQ(joints_[1].translation, rest_[1].translation);
  EXPECT_EQ(joints_[0].translation, glm::vec3(0.1f * 3.0f, 1.0f, 0.0f));
  EXPECT_EQ(joints_[1].scale, glm::vec3(2.0f));
  EXPECT_EQ(joints_[0].scale, glm::vec3(4.0f));
  EXPECT_THAT(blend_shapes_, ElementsAre(0.0f, 0.0f, 0.5f)) << "a whole pose";

  frame = {};
  frame.partial = true;
  frame.blend_shape_indices = {0};
  frame.blend_shapes = {0.25f};
  Apply(frame);
  EXPECT_EQ(joints_[1].scale, glm::vec3(2.0f)) << "a partial pose keeps the rest";
  EXPECT_THAT(blend_shapes_, ElementsAre(0.25f, 0.0f, 0.5f));
}

// Weights must not differ in their last bits for quaternions that are of unit length.
TEST_F(WireJoints, OnlyOtherLengthsAreNormalised) {
  protocol::PoseFrame frame;
  frame.rotations = {{0.6f, 0.0f, 0.0f, 0.8f}, {0.0f, 0.0f, 0.0f, 1.0005f}};
  Apply(frame);
  EXPECT_EQ(joints_[1].rotation, glm::quat(0.8f, 0.6f, 0.0f, 0.0f));
  EXPECT_FLOAT_EQ(joints_[0].rotation.w, 1.0f);
}

TEST_F(WireJoints, AnOfferHasLengthsInItsUnit) {
  protocol::SkeletonOffer offer;
  offer.joints.push_back({.name = "hips", .parent = -1, .rest_translation = {0.0f, 10.0f, 0.0f}});
  offer.joints.push_back(
      {.name = "knee", .parent = 0, .has_tail = true, .tail = {0.0f, 5.0f, 0.0f}});
  const auto joints = JointsOf(offer, 0.1f);
  ASSERT_EQ(joints.size(), 2u);
  EXPECT_EQ(joints[0].parent, wrinkle::kNoJoint);
  EXPECT_EQ(joints[0].rest.translation, glm::vec3(0.0f, 0.1f * 10.0f, 0.0f));
  EXPECT_FALSE(joints[0].tail);
  EXPECT_EQ(joints[1].parent, 0);
  EXPECT_EQ(joints[1].tail, glm::vec3(0.0f, 0.1f * 5.0f, 0.0f));
}

}  // namespace
}  // namespace furrow::recording
