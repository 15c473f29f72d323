// SPDX-License-Identifier: Apache-2.0
// Plays recordings of foreign skeletons on the default character's body.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "authoring/generator/body/body_skeleton.h"
#include "motion/clip/clip.h"
#include "motion/clip_file.h"
#include "rig/skeleton_match.h"
#include "wrinkle/skeleton/pose.h"

namespace furrow::authoring {
namespace {

namespace fs = std::filesystem;
using wrinkle::JointRole;
using enum JointRole;

constexpr JointRole kLimbs[][2] = {
    {kLeftUpperArm, kLeftLowerArm},   {kLeftLowerArm, kLeftHand},
    {kRightUpperArm, kRightLowerArm}, {kRightLowerArm, kRightHand},
    {kLeftUpperLeg, kLeftLowerLeg},   {kLeftLowerLeg, kLeftFoot},
    {kRightUpperLeg, kRightLowerLeg}, {kRightLowerLeg, kRightFoot},
};

// Compares a recording with the default body, frame by frame.
class BodyMotion : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    setenv("FURROW_DATA_DIR", (std::string(FURROW_SOURCE_DIR) + "/rig").c_str(), 1);
  }
  static void TearDownTestSuite() { unsetenv("FURROW_DATA_DIR"); }

  // Returns false if the recording is missing.
  bool Load(const char* recording, const motion::LoadOptions& options = {}) {
    const fs::path path = fs::path(FURROW_SHARED_DATA) / recording;
    if (!fs::exists(path)) return false;
    auto clip = motion::LoadClip(path, options);
    EXPECT_TRUE(clip.ok()) << clip.status().ToString();
    clip_ = *std::move(clip);
    const auto matcher = rig::SkeletonMatcher::Create("");
    EXPECT_TRUE(matcher.ok()) << matcher.status().ToString();
    match_ = matcher->Match(clip_.skeleton, {}, &body_);
    retarget_ = rig::MakeRetarget(match_, clip_.skeleton, body_);
    EXPECT_TRUE(retarget_.by_role());
    from_.resize(static_cast<std::size_t>(clip_.skeleton.num_joints()));
    to_.resize(static_cast<std::size_t>(body_.num_joints()));
    local_.resize(to_.size());
    return true;
  }

  void Show(int frame) {
    wrinkle::LocalPose pose;
    clip_.GetPose(frame, &pose);
    ASSERT_EQ(retarget_.Run(pose.joints, local_), wrinkle::JobStatus::kOk);
    ASSERT_EQ((wrinkle::LocalToModelJob{&clip_.skeleton, pose.joints, from_}).Run(),
              wrinkle::JobStatus::kOk);
    ASSERT_EQ((wrinkle::LocalToModelJob{&body_, local_, to_}).Run(), wrinkle::JobStatus::kOk);
  }

  static glm::vec3 Place(JointRole role, const wrinkle::JointRoles& roles,
                         const std::vector<glm::mat4>& model) {
    const auto found = std::ranges::find(roles, role) - roles.begin();
    return glm::vec3(model[static_cast<std::size_t>(found)][3]);
  }
  glm::vec3 From(JointRole role) const { return Place(role, match_.stream.roles, from_); }
  glm::vec3 To(JointRole role) const { return Place(role, match_.character.roles, to_); }

  float DegreesApart(JointRole from, JointRole to) const {
    const glm::vec3 a = glm::normalize(From(to) - From(from));
    const glm::vec3 b = glm::normalize(To(to) - To(from));
    return glm::degrees(2.0f * std::asin(0.5f * glm::distance(a, b)));
  }

  wrinkle::Skeleton body_ = MakeSkeleton();
  motion::Clip clip_;
  rig::SkeletonMatch match_;
  wrinkle::Retarget retarget_;
  std::vector<wrinkle::Transform> local_;
  std::vector<glm::mat4> from_;
  std::vector<glm::mat4> to_;
};

TEST_F(BodyMotion, CmuWalkKeepsItsLimbDirections) {
  if (!Load("cmu/01_01.bvh")) GTEST_SKIP() << "the CMU recording is missing";
  EXPECT_EQ(match_.stream.map, "cmu");
  EXPECT_TRUE(match_.stream.missing.empty());
  for (int frame = 0; frame < clip_.num_frames(); frame += 10) {
    Show(frame);
    for (const auto& [from, to] : kLimbs) {
      EXPECT_LT(DegreesApart(from, to), 0.5f) << wrinkle::ToString(from) << ", frame " << frame;
    }
    const float bend =
        glm::dot(glm::normalize(To(kHead) - To(kHips)), glm::normalize(From(kHead) - From(kHips)));
    EXPECT_GT(bend, std::cos(glm::radians(15.0f))) << "trunk, frame " << frame;
  }
}

// The lowest toe is on the floor, or in a jump at the height of the recording's lowest toe.
TEST_F(BodyMotion, CmuStandsOnTheFloor) {
  if (!Load("cmu/01_01.bvh")) GTEST_SKIP() << "the CMU recording is missing";
  const float scale = 0.93f / 16.9f;  // metres per CMU unit, from the leg lengths
  std::vector<float> lowest;
  for (int frame = 0; frame < clip_.num_frames(); frame += 10) {
    Show(frame);
    lowest.push_back(std::min(To(kLeftToes).y, To(kRightToes).y));
    const float theirs = scale * std::min(From(kLeftToes).y, From(kRightToes).y);
    EXPECT_NEAR(lowest.back(), theirs, 0.06f) << frame;
  }
  std::ranges::sort(lowest);
  EXPECT_NEAR(lowest[lowest.size() / 4], body_.rest_model()[body_.Find("toes_l")][3][1], 0.03f);
  EXPECT_GT(lowest.front(), -0.05f);
}

TEST_F(BodyMotion, VrmAnimationMovesTheBodyAndItsArms) {
  if (!Load("vrma/test.vrma")) GTEST_SKIP() << "the VRM animation is missing";
  EXPECT_EQ(match_.stream.map, "vrm");
  ASSERT_GT(clip_.num_frames(), 1);
  float most = 0.0f;
  for (int frame = 0; frame < clip_.num_frames(); ++frame) {
    Show(frame);
    for (const auto& [from, to] : kLimbs) {
      EXPECT_LT(DegreesApart(from, to), 0.5f) << wrinkle::ToString(from) << ", frame " << frame;
    }
    for (int joint = 0; joint < body_.num_joints(); ++joint) {
      most = std::max(
          most, glm::distance(glm::vec3(to_[joint][3]), glm::vec3(body_.rest_model()[joint][3])));
    }
  }
  EXPECT_GT(most, 0.05f);
}

// MakeHuman's rig has two joints per limb segment, five in the spine, and another rest pose.
TEST_F(BodyMotion, MakeHumanPosesKeepTheirLimbDirections) {
  // The file's positions are offsets from rest.
  if (!Load("makehuman/poses/benchmark.bvh", {.bvh_positions = motion::BvhPositions::kAdd}))
    GTEST_SKIP() << "MakeHuman's pose is missing";
  EXPECT_EQ(match_.stream.map, "makehuman");
  for (int frame = 0; frame < clip_.num_frames(); ++frame) {
    Show(frame);
    for (const auto& [from, to] : kLimbs) {
      EXPECT_LT(DegreesApart(from, to), 0.5f) << wrinkle::ToString(from) << ", frame " << frame;
    }
  }
}

}  // namespace
}  // namespace furrow::authoring
