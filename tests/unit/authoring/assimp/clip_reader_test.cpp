// SPDX-License-Identifier: Apache-2.0
// Clips that assimp's own exporters wrote. tests/end_to_end/test_foreign_recordings.py compares FBX
// files with forward kinematics of their properties.
#include "authoring/assimp/clip_reader.h"

#include <string>

#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "authoring/assimp/scene_file.h"
#include "motion/gltf/gltf_animation.h"
#include "tests/unit/authoring/import/model/toy_body.h"

namespace furrow::authoring {
namespace {

using ::testing::HasSubstr;
using wrinkle::kNoJoint;

constexpr int kFrames = 11;

motion::Clip Swinging() {
  motion::Clip clip;
  clip.name = "swing";
  clip.skeleton = *wrinkle::Skeleton::Create(
      // assimp's FBX exporter loses the transform of the topmost node.
      {{"root", kNoJoint, {}, {}},
       {"hips", 0, {{0, 1, 0}}, {}},
       {"spine", 1, {{0, 0.3f, 0}, glm::angleAxis(0.4f, glm::vec3(1, 0, 0))}, {}},
       {"head", 2, {{0, 0.4f, 0.1f}}, {}}});
  for (int f = 0; f < kFrames; ++f) {
    const float t = static_cast<float>(f) / 10.0f;
    clip.times.push_back(f / 10.0);
    clip.locals.push_back({});
    clip.locals.push_back({{t, 1.0f, 0.2f}, glm::angleAxis(t, glm::vec3(0, 1, 0))});
    clip.locals.push_back({{0, 0.3f, 0}, glm::angleAxis(0.4f + t, glm::vec3(1, 0, 0))});
    clip.locals.push_back({{0, 0.4f, 0.1f}, glm::angleAxis(-t, glm::vec3(0, 0, 1))});
  }
  return clip;
}

Result<motion::Clip> Read(const std::string& bytes, const std::string& extension,
                          const std::string& animation = {}, motion::ClipReport* report = nullptr) {
  Assimp::Importer importer;
  const Result<const aiScene*> scene = ReadScene(bytes, extension, Purpose::kAnimation, &importer);
  FURROW_RETURN_IF_ERROR(scene);
  motion::ClipReport ignored;
  return ReadClip(**scene, animation, report != nullptr ? report : &ignored);
}

// Model-space matrix of the joint `name`.
glm::mat4 ModelOf(const motion::Clip& clip, int frame, const std::string& name) {
  glm::mat4 model(1.0f);
  wrinkle::LocalPose pose;
  clip.GetPose(frame, &pose);
  for (int joint = clip.skeleton.Find(name); joint != kNoJoint;
       joint = clip.skeleton.joint_parents()[static_cast<std::size_t>(joint)]) {
    model = wrinkle::ToMatrix(pose.joints[static_cast<std::size_t>(joint)]) * model;
  }
  return model;
}

TEST(ClipReader, ReadsWhatAssimpWrote) {
  const motion::Clip clip = Swinging();
  const std::string bytes = ConvertByAssimp(*motion::ClipToGlb(clip), "fbxa");
  ASSERT_FALSE(bytes.empty());
  const Result<motion::Clip> read = Read(bytes, ".fbx");
  ASSERT_TRUE(read.ok()) << read.status().ToString();
  ASSERT_EQ(read->num_frames(), kFrames);
  for (int f = 0; f < kFrames; ++f) {
    EXPECT_NEAR(read->times[static_cast<std::size_t>(f)], clip.times[static_cast<std::size_t>(f)],
                1e-3);
    for (const std::string name : {"hips", "spine", "head"}) {
      // assimp's FBX files state centimetres, whatever the unit of their numbers.
      glm::mat4 expected = ModelOf(clip, f, name);
      expected[3] = glm::vec4(0.01f * glm::vec3(expected[3]), 1.0f);
      const glm::mat4 found = ModelOf(*read, f, name);
      for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 3; ++r) EXPECT_NEAR(found[c][r], expected[c][r], 2e-4) << name << f;
      }
    }
  }
}

TEST(ClipReader, ListsAndChoosesAnimations) {
  const std::string bytes = ConvertByAssimp(*motion::ClipToGlb(Swinging()), "fbxa");
  motion::ClipReport report;
  ASSERT_TRUE(Read(bytes, ".fbx", "0", &report).ok());
  ASSERT_EQ(report.animations.size(), 1u);
  EXPECT_NEAR(report.animations[0].seconds, 1.0, 1e-3);
  const Result<motion::Clip> missing = Read(bytes, ".fbx", "1");
  EXPECT_EQ(missing.status().code(), StatusCode::kNotFound);
  EXPECT_THAT(missing.status().ToString(), HasSubstr("animations: 0 "));
}

TEST(ClipReader, AFileWithoutAnimationIsRejected) {
  const std::string bytes = ConvertByAssimp(GlbOf(ToyBody()), "fbxa");
  const Result<motion::Clip> clip = Read(bytes, ".fbx");
  EXPECT_EQ(clip.status().code(), StatusCode::kSchema);
  EXPECT_THAT(clip.status().what(), HasSubstr("no animation"));
}

TEST(ReadScene, EveryTruncationEndsWell) {
  const std::string bytes = ConvertByAssimp(*motion::ClipToGlb(Swinging()), "fbxa");
  for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 40) {
    const Result<motion::Clip> clip = Read(bytes.substr(0, size), ".fbx");
    EXPECT_TRUE(clip.ok() || !clip.status().what().empty());
  }
}

TEST(ReadScene, UnknownExtensionsAreListed) {
  const Result<motion::Clip> clip = Read("text", ".txt");
  EXPECT_EQ(clip.status().code(), StatusCode::kUnsupported);
  EXPECT_THAT(clip.status().ToString(), HasSubstr("unknown file extension '.txt'"));
}

}  // namespace
}  // namespace furrow::authoring
