// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/weights/sliding_mask.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/wrinkle/oracle/ball.h"

namespace furrow::wrinkle {
namespace {

// A left hip at (0.1, 0.9, 0) with a thigh of 0.4 m straight down.
const BallFrame kHip{.origin = {0.1f, 0.9f, 0.0f}, .length = 0.4f};
const Mask kMask{.kind = Mask::Kind::kSliding, .texture = {}, .ball = "hip"};

// On the skin of the thigh: degrees from the front towards the subject's right, a quarter of a
// thigh away from its axis.
glm::vec3 OnThigh(float degrees, float below_metres) {
  const float angle = glm::radians(degrees);
  return kHip.origin + below_metres * kHip.bone +
         0.1f * (std::cos(angle) * kHip.forward + std::sin(angle) * kHip.right);
}

glm::vec3 Towards(float degrees, float bend) {
  const float angle = glm::radians(degrees);
  const BallShares shares = SplitBend(BallMode::kSmooth, bend, std::cos(angle), std::sin(angle));
  return BendDirection(kHip, shares.front, shares.back, shares.left, shares.right);
}

TEST(BendDirection, IsWhereTheJointBendsToHoweverFar) {
  for (const float bend : {0.05f, 0.5f, 1.0f}) {
    for (float degrees = -180.0f; degrees < 180.0f; degrees += 15.0f) {
      const glm::vec3 towards = Towards(degrees, bend);
      EXPECT_NEAR(glm::length(towards), 1.0f, 1e-5f);
      EXPECT_NEAR(glm::dot(towards, kHip.forward), std::cos(glm::radians(degrees)), 1e-4f);
      EXPECT_NEAR(glm::dot(towards, kHip.right), std::sin(glm::radians(degrees)), 1e-4f);
    }
  }
  EXPECT_EQ(BendDirection(kHip, 0.0f, 0.0f, 0.0f, 0.0f), glm::vec3(0.0f));
}

// Unlike fixed masks, the mask keeps its shape when it turns with the bend.
TEST(SlidingMaskAt, MovesRoundWithTheJoint) {
  for (const float turn : {10.0f, 77.0f, 180.0f, -120.0f}) {
    for (float degrees = -180.0f; degrees < 180.0f; degrees += 20.0f) {
      EXPECT_NEAR(SlidingMaskAt(kHip, kMask, Towards(0.0f, 0.6f), OnThigh(degrees, 0.05f)),
                  SlidingMaskAt(kHip, kMask, Towards(turn, 0.6f), OnThigh(degrees + turn, 0.05f)),
                  1e-4f);
    }
  }
}

TEST(SlidingMaskAt, IsFullInTheMiddleAndEndsWhereItSays) {
  const glm::vec3 front = Towards(0.0f, 1.0f);
  EXPECT_NEAR(SlidingMaskAt(kHip, kMask, front, OnThigh(0.0f, 0.06f)), 1.0f, 1e-5f);
  EXPECT_GT(SlidingMaskAt(kHip, kMask, front, OnThigh(95.0f, 0.06f)), 0.0f);
  EXPECT_EQ(SlidingMaskAt(kHip, kMask, front, OnThigh(101.0f, 0.06f)), 0.0f);
  EXPECT_EQ(SlidingMaskAt(kHip, kMask, front, OnThigh(180.0f, 0.06f)), 0.0f);
  EXPECT_GT(SlidingMaskAt(kHip, kMask, front, OnThigh(0.0f, 0.155f)), 0.0f);
  EXPECT_EQ(SlidingMaskAt(kHip, kMask, front, OnThigh(0.0f, 0.161f)), 0.0f);  // 0.4 thighs below
  EXPECT_GT(SlidingMaskAt(kHip, kMask, front, OnThigh(0.0f, -0.05f)), 0.0f);
  EXPECT_EQ(SlidingMaskAt(kHip, kMask, front, OnThigh(0.0f, -0.061f)), 0.0f);  // 0.15 above
  EXPECT_EQ(SlidingMaskAt(kHip, kMask, front, kHip.origin + 0.201f * kHip.forward), 0.0f);
  EXPECT_EQ(SlidingMaskAt(kHip, kMask, glm::vec3(0.0f), OnThigh(0.0f, 0.06f)), 0.0f);  // at rest
}

TEST(RestBallFrame, IsOfTheRestPose) {
  JointDesc hips{.name = "hips", .parent = kNoJoint};
  JointDesc thigh{.name = "thigh", .parent = 0};
  thigh.rest.translation = {0.1f, -0.1f, 0.0f};
  JointDesc shin{.name = "shin", .parent = 1};
  shin.rest.translation = {0.0f, -0.4f, 0.0f};
  const Skeleton skeleton = Skeleton::Create({hips, thigh, shin}).value();
  BallDriver ball{.parent = "hips", .joint = "thigh", .end = "shin", .bone = {0.0f, -2.0f, 0.0f}};
  const auto frame = RestBallFrame(ball, skeleton);
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->origin, glm::vec3(0.1f, -0.1f, 0.0f));
  EXPECT_EQ(frame->bone, glm::vec3(0.0f, -1.0f, 0.0f));
  EXPECT_EQ(frame->forward, glm::vec3(0.0f, 0.0f, 1.0f));
  EXPECT_EQ(frame->right, glm::vec3(-1.0f, 0.0f, 0.0f));
  EXPECT_FLOAT_EQ(frame->length, 0.4f);
  ball.end = "knee";
  EXPECT_FALSE(RestBallFrame(ball, skeleton).has_value());
}

}  // namespace
}  // namespace furrow::wrinkle
