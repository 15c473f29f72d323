// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/weights/sliding_mask.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/wrinkle/oracle/ball.h"

namespace furrow::wrinkle {
namespace {

// A left hip at (0.1, 0.9, 0) with a thigh of 0.4 m straight down.
const SlidingFrame kHip{.origin = {0.1f, 0.9f, 0.0f}, .length = 0.4f};
const Mask kMask{.kind = Mask::Kind::kSliding, .texture = {}, .driver = "hip"};

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
  return BendDirection(kHip, std::array{shares.front, shares.back, shares.left, shares.right});
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
  EXPECT_EQ(BendDirection(kHip, std::array{0.0f, 0.0f, 0.0f, 0.0f}), glm::vec3(0.0f));
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

Driver Named(Driver::Kind kind) {
  Driver driver;
  driver.name = "d";
  driver.kind = kind;
  return driver;
}

Feed FeedOf(const char* value) { return {.map = "folds", .sources = {{"d", value}}}; }

// A hip, a thigh 0.1 to its left, and a shin 0.4 below.
Skeleton Leg() {
  JointDesc hips{.name = "hips", .parent = kNoJoint};
  JointDesc thigh{.name = "thigh", .parent = 0};
  thigh.rest.translation = {0.1f, -0.1f, 0.0f};
  JointDesc shin{.name = "shin", .parent = 1};
  shin.rest.translation = {0.0f, -0.4f, 0.0f};
  shin.tail = glm::vec3(0.0f, -0.3f, 0.0f);
  return Skeleton::Create({hips, thigh, shin}).value();
}

void ExpectNear(const glm::vec3& a, const glm::vec3& b) {
  EXPECT_LT(glm::distance(a, b), 1e-6f) << a.x << " " << a.y << " " << a.z;
}

TEST(RestSlidingFrame, OfABallIsOfTheRestPose) {
  const Skeleton skeleton = Leg();
  Driver driver = Named(Driver::Kind::kBall);
  driver.ball = {.parent = "hips", .joint = "thigh", .end = "shin", .bone = {0.0f, -2.0f, 0.0f}};
  const auto frame = RestSlidingFrame(driver, FeedOf("front"), skeleton);
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->origin, glm::vec3(0.1f, -0.1f, 0.0f));
  EXPECT_EQ(frame->bone, glm::vec3(0.0f, -1.0f, 0.0f));
  EXPECT_EQ(frame->forward, glm::vec3(0.0f, 0.0f, 1.0f));
  EXPECT_EQ(frame->right, glm::vec3(-1.0f, 0.0f, 0.0f));
  EXPECT_FLOAT_EQ(frame->length, 0.4f);
  for (std::string* name : {&driver.ball.parent, &driver.ball.joint, &driver.ball.end}) {
    const std::string before = std::exchange(*name, "knee");
    EXPECT_FALSE(RestSlidingFrame(driver, FeedOf("front"), skeleton).has_value());
    *name = before;
  }
}

// A left knee flexes backwards about +x.
TEST(RestSlidingFrame, OfAHingeLiesOnTheSideOfItsValue) {
  const Skeleton skeleton = Leg();
  Driver driver = Named(Driver::Kind::kHinge);
  driver.hinge.parent = "thigh";
  driver.hinge.joint = "shin";
  driver.hinge.axis = glm::vec3(2.0f, 0.3f, 0.0f);  // only the part across the bone counts
  const std::array bent = {0.3f, 0.7f};
  const auto inner = RestSlidingFrame(driver, FeedOf("flexed"), skeleton);
  ASSERT_TRUE(inner.has_value());
  EXPECT_EQ(inner->origin, glm::vec3(0.1f, -0.5f, 0.0f));
  EXPECT_FLOAT_EQ(inner->length, 0.3f);
  ExpectNear(inner->bone, {0.0f, -1.0f, 0.0f});
  ExpectNear(BendDirection(*inner, bent), {0.0f, 0.0f, -1.0f});
  EXPECT_EQ(BendDirection(*inner, std::array{0.0f, 1.0f}), glm::vec3(0.0f));
  const auto outer = RestSlidingFrame(driver, FeedOf("extended"), skeleton);
  ASSERT_TRUE(outer.has_value());
  ExpectNear(BendDirection(*outer, bent), {0.0f, 0.0f, 1.0f});
  // Where both feed the map, and where neither does, the inner side counts.
  Feed both = FeedOf("extended");
  both.sources.push_back({"d", "flexed"});
  ExpectNear(BendDirection(*RestSlidingFrame(driver, both, skeleton), bent), {0.0f, 0.0f, -1.0f});
  Feed other = FeedOf("extended");
  other.sources[0].driver = "elbow";
  ExpectNear(BendDirection(*RestSlidingFrame(driver, other, skeleton), bent), {0.0f, 0.0f, -1.0f});

  driver.hinge.bone = glm::vec3(0.0f, 0.0f, 1.0f);  // a seated leg
  const auto seated = RestSlidingFrame(driver, FeedOf("flexed"), skeleton);
  ASSERT_TRUE(seated.has_value());
  ExpectNear(seated->bone, {0.0f, 0.0f, 1.0f});
  ExpectNear(BendDirection(*seated, bent),
             glm::normalize(glm::cross(glm::vec3(2.0f, 0.3f, 0.0f), glm::vec3(0, 0, 1))));
  driver.hinge.axis.reset();
  EXPECT_FALSE(RestSlidingFrame(driver, FeedOf("flexed"), skeleton).has_value());
}

// The mask goes where the front goes: the definition, by turning the front itself.
TEST(RestSlidingFrame, OfATwistFollowsTheFront) {
  const Skeleton skeleton = Leg();
  Driver driver = Named(Driver::Kind::kTwist);
  driver.twist.joint = "shin";
  const std::array left = {0.4f, 0.0f};
  const std::array right = {0.0f, 0.4f};
  for (const glm::vec3 axis : {glm::vec3(0, 1, 0), glm::vec3(0, -3, 0), glm::vec3(1, 0, 0),
                               glm::vec3(0.2f, 1, 0.5f), glm::vec3(0, 0, 1)}) {
    driver.twist.axis = axis;
    const auto frame = RestSlidingFrame(driver, FeedOf("twist_left"), skeleton);
    ASSERT_TRUE(frame.has_value());
    const glm::vec3 unit = glm::normalize(axis);
    const glm::vec3 front = axis.z == 1.0f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1);
    const glm::vec3 moved = glm::angleAxis(0.01f, unit) * front - front;
    EXPECT_GT(glm::dot(BendDirection(*frame, left), glm::normalize(moved)), 0.9999f);
    ExpectNear(BendDirection(*frame, right), -BendDirection(*frame, left));
    EXPECT_NEAR(glm::dot(BendDirection(*frame, left), unit), 0.0f, 1e-6f);
  }
  driver.twist.axis = glm::vec3(0, 1, 0);  // up: to the subject's left
  ExpectNear(BendDirection(*RestSlidingFrame(driver, FeedOf("twist_left"), skeleton), left),
             {1.0f, 0.0f, 0.0f});
  driver.twist.axis.reset();
  const auto own = RestSlidingFrame(driver, FeedOf("twist_left"), skeleton);
  ASSERT_TRUE(own.has_value());
  ExpectNear(own->bone, {0.0f, -1.0f, 0.0f});  // along its tail
  EXPECT_FLOAT_EQ(own->length, 0.3f);
}

TEST(RestSlidingFrame, IsNoneForDriversWithoutADirection) {
  for (const auto kind : {Driver::Kind::kPose, Driver::Kind::kBlendShape, Driver::Kind::kStrain}) {
    EXPECT_FALSE(RestSlidingFrame(Named(kind), FeedOf("value"), Leg()).has_value());
  }
}

}  // namespace
}  // namespace furrow::wrinkle
