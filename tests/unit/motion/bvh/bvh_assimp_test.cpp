// SPDX-License-Identifier: Apache-2.0
// Compares the BVH reader with an independent implementation, assimp 5.2.
#include <algorithm>
#include <map>
#include <string>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include "motion/bvh/bvh.h"
#include "tests/unit/motion/clip_testing.h"

namespace furrow::motion {
namespace {

// Model-space positions of all nodes in one frame, by name. assimp's times are frame numbers.
void AddPositions(const aiNode* node, const aiMatrix4x4& parent,
                  const std::map<std::string, const aiNodeAnim*>& channels, unsigned frame,
                  std::map<std::string, aiVector3D>* positions) {
  aiMatrix4x4 local = node->mTransformation;
  const auto found = channels.find(node->mName.C_Str());
  if (found != channels.end()) {
    const aiNodeAnim& channel = *found->second;
    local = aiMatrix4x4(
        aiVector3D(1), channel.mRotationKeys[std::min(frame, channel.mNumRotationKeys - 1)].mValue,
        channel.mPositionKeys[std::min(frame, channel.mNumPositionKeys - 1)].mValue);
  }
  const aiMatrix4x4 model = parent * local;
  (*positions)[node->mName.C_Str()] = aiVector3D(model.a4, model.b4, model.c4);
  for (unsigned i = 0; i < node->mNumChildren; ++i) {
    AddPositions(node->mChildren[i], model, channels, frame, positions);
  }
}

// Compares joints, and the tails of leaves with assimp's "EndSite_<joint>".
void CompareWithAssimp(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const std::string text = ReadAll(path);
  const Result<Clip> clip = ParseBvh(text, path.string());
  ASSERT_TRUE(clip.ok()) << clip.status().ToString();

  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  const aiScene* scene = importer.ReadFileFromMemory(text.data(), text.size(), 0, "bvh");
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumAnimations, 1u);
  std::map<std::string, const aiNodeAnim*> channels;
  for (unsigned i = 0; i < scene->mAnimations[0]->mNumChannels; ++i) {
    const aiNodeAnim* channel = scene->mAnimations[0]->mChannels[i];
    channels[channel->mNodeName.C_Str()] = channel;
  }

  float worst = 0.0f, worst_tail = 0.0f, size = 0.0f;
  std::string worst_joint;
  int compared = 0, tails = 0;
  for (int frame = 0; frame < clip->num_frames(); frame += 7) {
    std::map<std::string, aiVector3D> positions;
    AddPositions(scene->mRootNode, aiMatrix4x4(), channels, static_cast<unsigned>(frame),
                 &positions);
    const std::vector<glm::mat4> model = ModelMatrices(*clip, frame);
    for (std::size_t j = 0; j < model.size(); ++j) {
      const std::string& name = clip->skeleton.joint_names()[j];
      ASSERT_TRUE(positions.contains(name)) << name;
      const aiVector3D& theirs = positions[name];
      const glm::vec3 ours(model[j][3]);
      const float distance = glm::length(ours - glm::vec3(theirs.x, theirs.y, theirs.z));
      if (distance > worst) worst = distance, worst_joint = name;
      size = std::max(size, glm::length(ours));
      ++compared;
      const auto end = positions.find("EndSite_" + name);
      if (end == positions.end()) continue;
      const glm::vec3 tail(model[j] * glm::vec4(clip->skeleton.tails()[j], 1.0f));
      worst_tail = std::max(
          worst_tail, glm::length(tail - glm::vec3(end->second.x, end->second.y, end->second.z)));
      ++tails;
    }
  }
  std::printf("%s: %d joint positions and %d tails; worst error %.2e (%s) and %.2e, extent %.1f\n",
              path.filename().c_str(), compared, tails, static_cast<double>(worst),
              worst_joint.c_str(), static_cast<double>(worst_tail), static_cast<double>(size));
  EXPECT_GT(compared, 1000);
  EXPECT_GT(tails, 100);
  // Both compute in floats: allow 1e-5 of the extent.
  EXPECT_LT(worst, 1e-5f * size);
  EXPECT_LT(worst_tail, 1e-5f * size);
}

TEST(BvhAgainstAssimp, CmuBodyMocap) { CompareWithAssimp(SharedFile("cmu/01_01.bvh")); }
TEST(BvhAgainstAssimp, Emotions) { CompareWithAssimp(SharedFile("performances/emotions.bvh")); }
TEST(BvhAgainstAssimp, FacePoseUnits) {
  CompareWithAssimp(SharedFile("makehuman/poseunits/face-poseunits.bvh"));
}

}  // namespace
}  // namespace furrow::motion
