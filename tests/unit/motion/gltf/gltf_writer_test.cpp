// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include "motion/bvh/bvh.h"
#include "motion/gltf/gltf_animation.h"
#include "tests/unit/motion/clip_testing.h"

namespace furrow::motion {
namespace {

using wrinkle::kNoJoint;
using wrinkle::Skeleton;
using wrinkle::Transform;

Clip Rewrite(const Clip& clip) {
  const Result<std::string> glb = ClipToGlb(clip);
  EXPECT_TRUE(glb.ok()) << glb.status().ToString();
  Result<Clip> read = ParseGltfAnimation(*glb, "rewritten.glb");
  EXPECT_TRUE(read.ok()) << read.status().ToString();
  return read.ok() ? std::move(*read) : Clip();
}

Clip MakeFace() {
  Clip clip;
  clip.name = "face";
  clip.blend_shape_names = {"jawOpen", "browInnerUp", "cheekPuff"};
  for (int f = 0; f < 10; ++f) {
    clip.times.push_back(f / 30.0);
    for (int s = 0; s < 3; ++s) clip.blend_shapes.push_back(0.1f * static_cast<float>(f * s));
  }
  return clip;
}

TEST(GltfWriter, KeepsBvhClips) {
  for (const char* name : {"cmu/01_01.bvh", "performances/emotions.bvh"}) {
    if (!std::filesystem::exists(SharedFile(name))) GTEST_SKIP() << name << " is not there";
    const Result<Clip> clip = ParseBvh(ReadAll(SharedFile(name)), name);
    ASSERT_TRUE(clip.ok());
    const Clip read = Rewrite(*clip);
    ASSERT_EQ(read.num_frames(), clip->num_frames());
    EXPECT_EQ(read.skeleton.hash(), clip->skeleton.hash());  // names, rest pose and tails
    EXPECT_EQ(read.skeleton.num_joints(), clip->skeleton.num_joints());
    const float worst = WorstDistance(*clip, read);
    std::printf("%s: worst distance after glTF %.2e\n", name, static_cast<double>(worst));
    EXPECT_LT(worst, 1e-5f);
    for (std::size_t f = 0; f < clip->times.size(); ++f) {
      ASSERT_NEAR(read.times[f], clip->times[f], 2e-6);
    }
  }
}

TEST(GltfWriter, KeepsRestRotationsScalesAndBlendShapes) {
  Clip clip = MakeFace();
  const Transform rest{{0.0f, 2.0f, 0.0f}, glm::quat(0.5f, 0.5f, 0.5f, 0.5f), glm::vec3(2.0f)};
  clip.skeleton = *Skeleton::Create(
      {{"hips", kNoJoint, rest, {}}, {"still", 0, rest, {}}, {"eye", 1, rest, {{0, 0, 0.25f}}}});
  for (int f = 0; f < 10; ++f) {
    for (int j = 0; j < 3; ++j) clip.locals.push_back(rest);
    const auto t = 0.1f * static_cast<float>(f);
    clip.locals[static_cast<std::size_t>(3 * f)].translation.x = t;
    clip.locals[static_cast<std::size_t>(3 * f + 2)].scale = glm::vec3(1.0f + t);
    clip.locals[static_cast<std::size_t>(3 * f + 2)].rotation =
        glm::angleAxis(t, glm::vec3(0, 1, 0));
  }
  const Clip read = Rewrite(clip);
  EXPECT_EQ(read.name, "face");
  EXPECT_EQ(read.skeleton.hash(), clip.skeleton.hash());
  EXPECT_EQ(read.blend_shape_names, clip.blend_shape_names);
  EXPECT_EQ(read.blend_shapes, clip.blend_shapes);
  ASSERT_EQ(read.locals.size(), clip.locals.size());
  EXPECT_LT(WorstDistance(clip, read), 1e-6f);
  for (std::size_t i = 0; i < clip.locals.size(); ++i) {
    EXPECT_EQ(read.locals[i].scale, clip.locals[i].scale);
    EXPECT_GT(std::abs(glm::dot(read.locals[i].rotation, clip.locals[i].rotation)), 0.999999f);
  }
}

TEST(GltfWriter, WritesBlendShapesAlone) {
  const Clip clip = MakeFace();
  const Clip read = Rewrite(clip);
  EXPECT_EQ(read.skeleton.num_joints(), 0);
  EXPECT_EQ(read.blend_shapes, clip.blend_shapes);
}

TEST(GltfWriter, WritesClipsWithoutMotion) {
  Clip clip;
  clip.skeleton = *Skeleton::Create({{"a", kNoJoint, {}, {}}});
  clip.times = {0.0, 1.0};
  clip.locals = {{}, {}};
  EXPECT_EQ(Rewrite(clip).num_frames(), 2);
}

// Checks the file with an independent reader.
TEST(GltfWriter, AssimpReadsIt) {
  Clip clip = MakeFace();
  clip.skeleton = *Skeleton::Create({{"hips", kNoJoint, {}, {}}, {"knee", 0, {{0, -1, 0}}, {}}});
  for (int f = 0; f < 10; ++f) {
    clip.locals.push_back({{0.5f * static_cast<float>(f), 0.0f, 0.0f}});
    clip.locals.push_back({{0.0f, -1.0f, 0.0f}});
  }
  const std::string glb = *ClipToGlb(clip);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFileFromMemory(glb.data(), glb.size(), 0, "glb");
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumAnimations, 1u);
  EXPECT_NE(scene->mRootNode->FindNode("knee"), nullptr);
  const aiAnimation& animation = *scene->mAnimations[0];
  EXPECT_EQ(animation.mNumMorphMeshChannels, 1u);
  ASSERT_EQ(animation.mNumChannels, 1u);
  EXPECT_STREQ(animation.mChannels[0]->mNodeName.C_Str(), "hips");
  ASSERT_EQ(animation.mChannels[0]->mNumPositionKeys, 10u);
  EXPECT_FLOAT_EQ(animation.mChannels[0]->mPositionKeys[9].mValue.x, 4.5f);
}

TEST(GltfWriter, RejectsClipsThatGltfCannotExpress) {
  EXPECT_EQ(ClipToGlb(Clip()).status().code(), StatusCode::kUnsupported);
  Clip empty = MakeFace();
  empty.times.clear();
  empty.blend_shapes.clear();
  EXPECT_EQ(ClipToGlb(empty).status().code(), StatusCode::kInvalidArgument);
  Clip dense = MakeFace();
  for (double& time : dense.times) time += 1e6;
  EXPECT_EQ(ClipToGlb(dense).status().code(), StatusCode::kOk);  // times count from the first frame
  dense.times.front() = 0.0;
  EXPECT_EQ(ClipToGlb(dense).status().code(), StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace furrow::motion
