// SPDX-License-Identifier: Apache-2.0
//
// Tests the shipped MakeHuman rig with the real skeleton, poses and performance.
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "authoring/import/makehuman/formats/mhskel.h"
#include "authoring/import/makehuman/formats/obj.h"
#include "base/files.h"
#include "motion/clip/clip.h"
#include "motion/clip_file.h"
#include "motion/pose_source.h"
#include "rig/rig_file.h"
#include "wrinkle/solver/solver.h"

namespace furrow::authoring {
namespace {

namespace fs = std::filesystem;

const fs::path kShared = FURROW_SHARED_DATA;
const fs::path kMakeHuman = kShared / "makehuman";
const fs::path kRig = fs::path(FURROW_SOURCE_DIR) / "rig/rigs/makehuman.json";

// emotions.bvh contains five expressions of 120 frames each, with the peak in the middle.
constexpr std::array<const char*, 6> kNames{"neutral", "smile",   "anger",
                                            "sadness", "disgust", "laugh"};
constexpr std::array<int, 6> kFrames{0, 60, 180, 300, 420, 540};

class MakeHumanExpressions : public testing::Test {
 protected:
  using Weights = std::map<std::string, float>;

  static void SetUpTestSuite() {
    if (!fs::exists(kMakeHuman)) return;
    const Result<std::string> text = ReadFile(kRig, kMaxTextFileBytes);
    ASSERT_TRUE(text.ok()) << text.status().ToString();
    const Result<wrinkle::Rig> rig =
        rig::ParseRig(*text, kRig.string(), kMakeHuman / "poseunits", motion::CachedPoseSource());
    ASSERT_TRUE(rig.ok()) << rig.status().ToString();
    const Result<motion::Clip> clip = motion::LoadClip(kShared / "performances/emotions.bvh");
    ASSERT_TRUE(clip.ok()) << clip.status().ToString();
    Result<wrinkle::RigBinding> binding = wrinkle::RigBinding::Create(*rig, clip->skeleton, {});
    ASSERT_TRUE(binding.ok()) << binding.status().ToString();
    wrinkle::SubjectSolver solver(std::make_shared<wrinkle::RigBinding>(std::move(*binding)),
                                  false);
    for (std::size_t e = 0; e < kFrames.size(); ++e) {
      wrinkle::LocalPose pose;
      clip->GetPose(kFrames[e], &pose);
      ASSERT_EQ(solver.Update(pose, 1.0 / 30.0), wrinkle::JobStatus::kOk);
      const auto names = solver.binding().weight_names();
      for (std::size_t i = 0; i < names.size(); ++i)
        weights_[kNames[e]][names[i]] = solver.wrinkle_weights()[i];
    }
  }

  void SetUp() override {
    if (!fs::exists(kMakeHuman)) GTEST_SKIP() << kMakeHuman << " is missing";
    ASSERT_EQ(weights_.size(), kNames.size());
  }

  static float Get(const char* expression, const char* weight) {
    const auto found = weights_[expression].find(weight);
    EXPECT_NE(found, weights_[expression].end()) << weight;
    return found == weights_[expression].end() ? -1.0f : found->second;
  }

  static bool IsFacial(const std::string& name) {
    return name.ends_with(".stretch") || name.ends_with(".squash");
  }

  static inline std::map<std::string, Weights> weights_;
};

TEST_F(MakeHumanExpressions, NeutralFaceHasNoWrinkles) {
  for (const auto& [name, weight] : weights_["neutral"]) {
    if (!IsFacial(name)) continue;
    EXPECT_LT(weight, 0.02f) << name;
  }
}

TEST_F(MakeHumanExpressions, RaiseTheExpectedWeights) {
  std::printf("%-18s", "");
  for (const char* name : kNames) std::printf("%9s", name);
  std::printf("\n");
  for (const auto& [name, unused] : weights_["neutral"]) {
    if (!IsFacial(name)) continue;
    std::printf("%-18s", name.c_str());
    for (const char* expression : kNames) std::printf("%9.3f", weights_[expression][name]);
    std::printf("\n");
  }
  EXPECT_GT(Get("smile", "mouth_l.squash"), 0.7f);
  EXPECT_GT(Get("smile", "mouth_r.squash"), 0.3f);  // this smile is asymmetric
  EXPECT_GT(Get("smile", "eye_l.squash"), 0.4f);
  EXPECT_LT(Get("smile", "glabella.squash"), 0.1f);
  EXPECT_GT(Get("anger", "glabella.squash"), 0.9f);
  EXPECT_GT(Get("anger", "brow_l.squash"), 0.7f);
  EXPECT_LT(Get("anger", "brow_l.stretch"), 0.05f);
  EXPECT_GT(Get("sadness", "brow_l.stretch"), 0.15f);
  EXPECT_GT(Get("sadness", "mouth_l.stretch"), 0.5f);
  EXPECT_LT(Get("sadness", "nose.squash"), 0.05f);
  EXPECT_GT(Get("disgust", "nose.squash"), 0.8f);
  EXPECT_GT(Get("disgust", "mouth_r.stretch"), 0.5f);
  EXPECT_GT(Get("laugh", "mouth_l.squash"), 0.7f);
  EXPECT_GT(Get("laugh", "eye_r.squash"), 0.5f);
  EXPECT_LT(Get("laugh", "brow_l.squash"), 0.05f);
}

// For each pair of expressions at least one facial weight differs.
TEST_F(MakeHumanExpressions, DifferFromEachOther) {
  for (std::size_t a = 0; a < kNames.size(); ++a) {
    for (std::size_t b = a + 1; b < kNames.size(); ++b) {
      float most = 0.0f;
      for (const auto& [name, weight] : weights_[kNames[a]]) {
        if (IsFacial(name)) most = std::max(most, std::abs(weight - weights_[kNames[b]][name]));
      }
      EXPECT_GT(most, 0.25f) << kNames[a] << " and " << kNames[b];
    }
  }
}

// The expressions that emotions.bvh was composed from. emotions.bvh multiplies the pose units in
// the other order than MakeHuman, so weights near the mouth differ by up to 0.17.
TEST_F(MakeHumanExpressions, MhposeFilesRaiseTheExpectedWeights) {
  const Result<std::string> text = ReadFile(kRig, kMaxTextFileBytes);
  ASSERT_TRUE(text.ok());
  const Result<wrinkle::Rig> rig =
      rig::ParseRig(*text, kRig.string(), kMakeHuman / "poseunits", motion::CachedPoseSource());
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  std::map<std::string, Weights> seen;
  for (const char* name : {"smile02", "anger01", "sad01", "disgust01", "laugh01"}) {
    const Result<motion::Clip> clip =
        motion::LoadClip(kMakeHuman / "expressions" / (std::string(name) + ".mhpose"));
    ASSERT_TRUE(clip.ok()) << clip.status().ToString();
    Result<wrinkle::RigBinding> binding = wrinkle::RigBinding::Create(*rig, clip->skeleton, {});
    ASSERT_TRUE(binding.ok()) << binding.status().ToString();
    wrinkle::SubjectSolver solver(std::make_shared<wrinkle::RigBinding>(std::move(*binding)),
                                  false);
    wrinkle::LocalPose pose;
    clip->GetPose(0, &pose);
    ASSERT_EQ(solver.Update(pose, 1.0 / 30.0), wrinkle::JobStatus::kOk);
    const auto names = solver.binding().weight_names();
    for (std::size_t i = 0; i < names.size(); ++i)
      seen[name][names[i]] = solver.wrinkle_weights()[i];
  }
  EXPECT_GT(seen["smile02"]["mouth_l.squash"], 0.7f);
  EXPECT_GT(seen["smile02"]["eye_l.squash"], 0.4f);
  EXPECT_LT(seen["smile02"]["glabella.squash"], 0.1f);
  EXPECT_GT(seen["anger01"]["glabella.squash"], 0.9f);
  EXPECT_GT(seen["anger01"]["brow_l.squash"], 0.7f);
  EXPECT_GT(seen["disgust01"]["nose.squash"], 0.8f);
  EXPECT_GT(seen["disgust01"]["mouth_r.stretch"], 0.5f);
  EXPECT_GT(seen["laugh01"]["mouth_l.squash"], 0.7f);
  EXPECT_GT(seen["laugh01"]["eye_r.squash"], 0.5f);
  EXPECT_LT(seen["laugh01"]["brow_l.squash"], 0.05f);
  // The order does not matter where the units turn different joints.
  for (const auto& [name, weight] : seen["sad01"]) {
    if (!IsFacial(name)) continue;
    EXPECT_NEAR(weight, Get("sadness", name.c_str()), 0.02f) << name;
  }
}

// MakeHuman's BVH files were made for a specific person, and base.obj is the mesh before it is
// shaped. They have the same joints, parents and bone directions, but lengths differ by up to 5 cm.
TEST(MakeHumanSkeleton, AgreesWithThePoseUnits) {
  if (!fs::exists(kMakeHuman)) GTEST_SKIP() << kMakeHuman << " is missing";
  const Result<std::string> obj_text = ReadFile(kMakeHuman / "3dobjs/base.obj", kMaxTextFileBytes);
  const Result<std::string> skel_text =
      ReadFile(kMakeHuman / "rigs/default.mhskel", kMaxTextFileBytes);
  ASSERT_TRUE(obj_text.ok() && skel_text.ok());
  const Result<ObjMesh> obj = ParseObj(*obj_text, "base.obj");
  ASSERT_TRUE(obj.ok()) << obj.status().ToString();
  const Result<MhSkeleton> joints = ParseMhskel(*skel_text, "default.mhskel");
  ASSERT_TRUE(joints.ok()) << joints.status().ToString();
  const Result<wrinkle::Skeleton> ours = BuildSkeleton(*joints, obj->positions, "default.mhskel");
  ASSERT_TRUE(ours.ok()) << ours.status().ToString();
  const Result<motion::Clip> clip = motion::LoadClip(kMakeHuman / "poseunits/face-poseunits.bvh");
  ASSERT_TRUE(clip.ok()) << clip.status().ToString();
  const wrinkle::Skeleton& theirs = clip->skeleton;
  ASSERT_EQ(ours->num_joints(), 163);
  ASSERT_EQ(theirs.num_joints(), 163);
  float worst = 0.0f;
  for (int j = 0; j < 163; ++j) {
    const auto there = static_cast<std::size_t>(j);
    const int found = ours->Find(theirs.joint_names()[there]);
    ASSERT_NE(found, wrinkle::kNoJoint) << theirs.joint_names()[there];
    const auto here = static_cast<std::size_t>(found);
    const int parent = theirs.joint_parents()[there];
    if (parent == wrinkle::kNoJoint) {
      EXPECT_EQ(ours->joint_parents()[here], wrinkle::kNoJoint);
      continue;
    }
    ASSERT_NE(ours->joint_parents()[here], wrinkle::kNoJoint);
    EXPECT_EQ(ours->joint_names()[static_cast<std::size_t>(ours->joint_parents()[here])],
              theirs.joint_names()[static_cast<std::size_t>(parent)]);
    const glm::vec3 a = ours->rest_pose()[here].translation;
    const glm::vec3 b = theirs.rest_pose()[there].translation;
    worst = std::max(worst, glm::distance(a, b));
  }
  std::printf("largest difference of an offset: %.3f dm\n", worst);
  EXPECT_LT(worst, 0.5f);
}

}  // namespace
}  // namespace furrow::authoring
