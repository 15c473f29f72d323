// SPDX-License-Identifier: Apache-2.0
#include "server/session/subjects/rest_detector.h"

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

namespace furrow::server {
namespace {

TEST(RestDetector, InvisibleTremorIsNotMovement) {
  wrinkle::LocalPose pose;
  pose.joints.resize(1);
  RestDetector rest;
  rest.Update(pose, {}, FromSeconds(1));
  pose.joints[0].rotation = glm::angleAxis(1e-4f, glm::vec3(1, 0, 0));
  rest.Update(pose, {}, FromSeconds(2));
  EXPECT_EQ(rest.moved_at(), FromSeconds(1));
  pose.joints[0].rotation = glm::angleAxis(1e-2f, glm::vec3(1, 0, 0));
  rest.Update(pose, {}, FromSeconds(3));
  EXPECT_EQ(rest.moved_at(), FromSeconds(3));
}

// Trackers change between the two at will.
TEST(RestDetector, AQuaternionAndItsNegativeAreOneRotation) {
  wrinkle::LocalPose pose;
  pose.joints.resize(1);
  pose.joints[0].rotation = glm::angleAxis(1.0f, glm::vec3(0, 1, 0));
  RestDetector rest;
  rest.Update(pose, {}, FromSeconds(1));
  pose.joints[0].rotation = -pose.joints[0].rotation;
  rest.Update(pose, {}, FromSeconds(2));
  EXPECT_EQ(rest.moved_at(), FromSeconds(1));
}

}  // namespace
}  // namespace furrow::server
