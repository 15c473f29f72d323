// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/shapes/head_turn.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/wrinkle/test_characters.h"

namespace furrow::wrinkle {
namespace {

const std::vector<std::string> kTurnStream = {"jawOpen", "HeadYaw", "headpitch", "HeadRoll"};

// Where the head points the model's axes after the turn: X to its left, Y up, Z to the front.
glm::mat3 HeadAxes(const Skeleton& skeleton, const std::vector<Transform>& local) {
  std::vector<glm::mat4> model(skeleton.num_joints());
  EXPECT_EQ((LocalToModelJob{&skeleton, local, model}.Run()), JobStatus::kOk);
  const int head = skeleton.Find("head");
  return glm::mat3(model[head]) * glm::transpose(glm::mat3(skeleton.rest_model()[head]));
}

std::vector<Transform> Turned(const Skeleton& skeleton, const std::vector<float>& values) {
  const HeadTurn turn = HeadTurn::Create(skeleton, {}, kTurnStream);
  EXPECT_FALSE(turn.empty());
  std::vector<Transform> local(skeleton.rest_pose().begin(), skeleton.rest_pose().end());
  EXPECT_EQ(turn.Run(values, local), JobStatus::kOk);
  return local;
}

// Whatever the joints' own frames are.
TEST(HeadTurn, TurnsLeftRaisesTheChinAndLowersTheRightEar) {
  for (const unsigned seed : {0u, 5u, 9u}) {
    const Skeleton body = MakeBody(seed);
    const glm::mat3 yaw = HeadAxes(body, Turned(body, {0.0f, 0.5f}));
    EXPECT_NEAR(yaw[2].x, std::sin(0.5f), 1e-5f) << "the face looks left";
    EXPECT_NEAR(yaw[1].y, 1.0f, 1e-5f);
    const glm::mat3 pitch = HeadAxes(body, Turned(body, {0.0f, 0.0f, 0.5f}));
    EXPECT_NEAR(pitch[2].y, std::sin(0.5f), 1e-5f) << "the face looks up";
    const glm::mat3 roll = HeadAxes(body, Turned(body, {0.0f, 0.0f, 0.0f, 0.5f}));
    EXPECT_NEAR(roll[0].y, std::sin(0.5f), 1e-5f) << "the left ear rises";
  }
}

TEST(HeadTurn, TheNeckTakesItsShare) {
  const Skeleton body = MakeBody(5);
  const std::vector<Transform> local = Turned(body, {0.0f, 0.5f});
  const auto angle = [&](const char* name) {
    const int joint = body.Find(name);
    const float cosine =
        std::abs(glm::dot(local[joint].rotation, body.rest_pose()[joint].rotation));
    return 2.0f * std::acos(std::min(1.0f, cosine));
  };
  EXPECT_NEAR(angle("neck"), 0.2f, 1e-3f);
  EXPECT_NEAR(angle("head"), 0.3f, 1e-3f);
}

TEST(HeadTurn, RolesNameTheJoints) {
  const Skeleton body = MakeBody();
  JointRoles roles(body.joint_names().size(), JointRole::kNone);
  EXPECT_TRUE(HeadTurn::Create(body, roles, kTurnStream).empty());
  roles[static_cast<std::size_t>(body.Find("spine"))] = JointRole::kHead;
  const HeadTurn turn = HeadTurn::Create(body, roles, kTurnStream);
  std::vector<Transform> local(body.rest_pose().begin(), body.rest_pose().end());
  ASSERT_EQ(turn.Run(std::vector<float>{0.0f, 0.5f}, local), JobStatus::kOk);
  EXPECT_NE(local[body.Find("spine")].rotation, body.rest_pose()[body.Find("spine")].rotation);
  EXPECT_EQ(local[body.Find("head")].rotation, body.rest_pose()[body.Find("head")].rotation);
}

TEST(HeadTurn, AnglesAreLimitedAndBadInputChangesNothing) {
  const Skeleton body = MakeBody();
  EXPECT_TRUE(HeadTurn::Create(body, {}, std::vector<std::string>{"jawOpen"}).empty());
  const glm::mat3 wild = HeadAxes(body, Turned(body, {0.0f, 1e9f}));
  EXPECT_NEAR(wild[2].x, std::sin(1.5f), 1e-4f);
  const HeadTurn turn = HeadTurn::Create(body, {}, kTurnStream);
  std::vector<Transform> local(body.rest_pose().begin(), body.rest_pose().end());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(turn.Run(std::vector<float>{nan, 0.5f}, local), JobStatus::kNonFinite);
  EXPECT_EQ(turn.Run(std::vector<float>{0.0f, 0.5f}, std::span(local).first(2)),
            JobStatus::kSizeMismatch);
  EXPECT_EQ(local[body.Find("head")].rotation, body.rest_pose()[body.Find("head")].rotation);
}

TEST(HeadTurn, AnglesOfTrackersHaveExactNames) {
  for (const char* name : {"HeadYaw", "headpitch", "LeftEyeRoll", "rightEyeYaw"}) {
    EXPECT_TRUE(IsTrackerAngle(name)) << name;
  }
  for (const char* name : {"TongueRoll", "mouthRollLower", "Yaw", "Head", "HeadYawLeft", ""}) {
    EXPECT_FALSE(IsTrackerAngle(name)) << name;
  }
}

}  // namespace
}  // namespace furrow::wrinkle
