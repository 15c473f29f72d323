// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/recordings/recordings.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "authoring/generator/body/body_skeleton.h"
#include "authoring/generator/recordings/frame_pose.h"
#include "rig/rig_file.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

class RecordingTest : public ::testing::Test {
 protected:
  Recording Make(const char* name) {
    Result<Recording> recording = MakeRecording(name, rig_.value(), skeleton_);
    EXPECT_TRUE(recording.ok()) << recording.status().ToString();
    return recording.ok() ? std::move(recording).value() : Recording();
  }

  // The position in `frame` of a point fixed to a joint. `at` is its rest position in model space.
  vec3 PlaceOf(const std::vector<wrinkle::Transform>& frame, const char* joint, const vec3& at) {
    const int index = skeleton_.Find(joint);
    vec3 place = at - vec3(skeleton_.rest_model()[index][3]);
    for (int j = index; j != wrinkle::kNoJoint; j = skeleton_.joint_parents()[j]) {
      place = frame[j].translation + frame[j].rotation * place;
    }
    return place;
  }

  Result<wrinkle::Rig> rig_ =
      rig::LoadRig(std::filesystem::path(FURROW_SOURCE_DIR) / "rig/rigs/default.json");
  wrinkle::Skeleton skeleton_ = MakeSkeleton();
};

// The foot does not slide while its heel and ball are both near the floor.
TEST_F(RecordingTest, WalkingFeetDoNotSlide) {
  const Recording walk = Make("walk");
  int standing = 0;
  for (const auto& [foot, side] : {std::pair("foot_l", 1.0f), std::pair("foot_r", -1.0f)}) {
    const vec3 heel(side * 0.1f, 0.0f, -0.072f), ball(side * 0.1f, 0.022f, 0.115f);
    vec3 before(0.0f);
    bool was_down = false;
    for (std::size_t f = 0; f < walk.frames.size(); ++f) {
      const vec3 h = PlaceOf(walk.frames[f], foot, heel);
      const vec3 b = PlaceOf(walk.frames[f], foot, ball);
      EXPECT_GT(std::min(h.y, b.y), -0.012f) << foot << " frame " << f;  // not below the floor
      const bool is_down = h.y < 0.004f && b.y < 0.026f;
      if (is_down && was_down) {
        ++standing;
        EXPECT_LT(glm::distance(b, before), 0.003f) << foot << " frame " << f;
      }
      was_down = is_down;
      before = b;
    }
  }
  EXPECT_GT(standing, 100);
  // The walk covers about 1 m per second.
  const float way = walk.frames.back()[0].translation.z - walk.frames.front()[0].translation.z;
  EXPECT_NEAR(way, 10.3f, 0.3f);
}

// The walk has nine whole cycles, so the last frame continues with the first.
TEST_F(RecordingTest, WalkLoops) {
  const Recording walk = Make("walk");
  const auto& last = walk.frames.back();
  const auto& first = walk.frames.front();
  for (const char* name : {"upper_leg_l", "lower_leg_l", "upper_leg_r", "lower_leg_r"}) {
    const int j = skeleton_.Find(name);
    EXPECT_GT(std::abs(glm::dot(last[j].rotation, first[j].rotation)), 0.995f) << name;
  }
}

TEST_F(RecordingTest, SquatKeepsTheFeetOnTheFloor) {
  const Recording squat = Make("squat");
  float lowest = 1.0f, highest_hand = 0.0f;
  for (const auto& frame : squat.frames) {
    lowest = std::min(lowest, frame[0].translation.y);
    highest_hand =
        std::max(highest_hand,
                 PlaceOf(frame, "hand_l", skeleton_.rest_model()[skeleton_.Find("hand_l")][3]).y);
    const vec3 sole = PlaceOf(frame, "foot_l", {0.1f, 0.0f, 0.03f});
    EXPECT_NEAR(sole.y, 0.0f, 0.015f);
  }
  EXPECT_LT(lowest, 0.55f);
  EXPECT_GT(highest_hand, 1.75f);
}

// Bending the hip and the knee moves the ankle to its target for any turn of the hips.
TEST_F(RecordingTest, PlantFootReachesItsTarget) {
  for (const float turn : {0.0f, 15.0f, -30.0f}) {
    FramePose pose(rig_.value(), skeleton_);
    pose.Turn("hips", 0.5f * turn, turn, 0.3f * turn);
    pose.Move("hips", {0.02f, -0.15f, 0.1f});
    const vec3 want(0.13f, 0.12f, 0.2f);
    pose.PlantFoot(1.0f, want, 10.0f, 5.0f);
    EXPECT_LT(glm::distance(pose.PlaceOf("foot_l"), want), 1e-4f) << turn;
  }
  FramePose pose(rig_.value(), skeleton_);
  pose.PlantFoot(-1.0f, {-0.1f, -1.0f, 0.0f}, 0.0f, 0.0f);  // out of reach: as near as possible
  EXPECT_NEAR(glm::distance(pose.PlaceOf("foot_r"), pose.PlaceOf("upper_leg_r")), 0.826f, 0.004f);
}

// Left and right differ, but only slightly.
TEST_F(RecordingTest, FacesAreNotSymmetric) {
  const Recording smile = Make("happiness");
  const int left = skeleton_.Find("risorius_l"), right = skeleton_.Find("risorius_r");
  float most = 0.0f;
  for (const auto& frame : smile.frames) {
    const vec3 a = frame[left].translation - skeleton_.rest_pose()[left].translation;
    const vec3 b = frame[right].translation - skeleton_.rest_pose()[right].translation;
    most = std::max(most, glm::distance(a, vec3(-b.x, b.y, b.z)));
  }
  EXPECT_GT(most, 0.0005f);
  EXPECT_LT(most, 0.006f);
}

// The jaw opens and closes several times per second.
TEST_F(RecordingTest, ConversationMovesTheMouth) {
  const Recording talk = Make("conversation");
  const int jaw = skeleton_.Find("jaw");
  int turns = 0;
  float before = 0.0f, slope = 0.0f;
  for (const auto& frame : talk.frames) {
    const float open = 2.0f * std::acos(std::min(std::abs(frame[jaw].rotation.w), 1.0f));
    if (std::abs(open - before) > 1e-3f) {
      turns += (open - before) * slope < 0.0f;
      slope = open - before;
    }
    before = open;
  }
  EXPECT_GT(turns, 20);
  EXPECT_EQ(talk.frames.size(), 20u * kFramesPerSecond);
}

}  // namespace
}  // namespace furrow::authoring
