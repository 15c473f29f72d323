// SPDX-License-Identifier: Apache-2.0
// Scenes that the test makes. import_model_test reads files of assimp's exporters.
#include "authoring/assimp/model_writer.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <assimp/scene.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

// A triangle.
aiMesh* MakeMesh(const char* name) {
  auto* mesh = new aiMesh;
  mesh->mName = name;
  mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  mesh->mNumVertices = 3;
  mesh->mVertices = new aiVector3D[3]{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh->mNumFaces = 1;
  mesh->mFaces = new aiFace[1];
  mesh->mFaces[0].mNumIndices = 3;
  mesh->mFaces[0].mIndices = new unsigned[3]{0, 1, 2};
  return mesh;
}

// A body that follows the joint "hips", which has `num_parts` rigid parts: "part_0" and so on, each
// 2 m to the side. The animation has a channel for each of them; in its second key, the part is
// moved by `offset` metres and turned by `turn` (the sine of half of the angle).
std::unique_ptr<aiScene> MakeScene(int num_parts, float offset, float turn = 0.0f) {
  auto scene = std::make_unique<aiScene>();
  scene->mNumMaterials = 1;
  scene->mMaterials = new aiMaterial* [1] { new aiMaterial };
  scene->mNumMeshes = 2;
  scene->mMeshes = new aiMesh* [2] { MakeMesh("body"), MakeMesh("part") };
  aiMesh& body = *scene->mMeshes[0];
  body.mNumBones = 1;
  body.mBones = new aiBone* [1] { new aiBone };
  body.mBones[0]->mName = "hips";
  body.mBones[0]->mNumWeights = 3;
  body.mBones[0]->mWeights = new aiVertexWeight[3]{{0, 1.0f}, {1, 1.0f}, {2, 1.0f}};
  auto* root = new aiNode("root");
  auto* hips = new aiNode("hips");
  auto* holder = new aiNode("body");
  holder->mNumMeshes = 1;
  holder->mMeshes = new unsigned[1]{0};
  std::vector<aiNode*> parts;
  auto* animation = new aiAnimation;
  animation->mNumChannels = static_cast<unsigned>(num_parts);
  animation->mChannels = new aiNodeAnim*[animation->mNumChannels];
  for (int i = 0; i < num_parts; ++i) {
    auto* part = new aiNode("part_" + std::to_string(i));
    aiMatrix4x4::Translation(aiVector3D(2, 0, 0), part->mTransformation);
    part->mNumMeshes = 1;
    part->mMeshes = new unsigned[1]{1};
    parts.push_back(part);
    auto* channel = new aiNodeAnim;
    channel->mNodeName = part->mName;
    channel->mNumPositionKeys = 2;
    channel->mPositionKeys = new aiVectorKey[2]{{0.0, {2, 0, 0}}, {1.0, {2, offset, 0}}};
    channel->mNumRotationKeys = 2;
    channel->mRotationKeys =
        new aiQuatKey[2]{{0.0, aiQuaternion(-1, 0, 0, 0)},
                         {1.0, aiQuaternion(std::sqrt(1.0f - turn * turn), turn, 0, 0)}};
    channel->mNumScalingKeys = 1;
    channel->mScalingKeys = new aiVectorKey[1]{{0.0, {1, 1, 1}}};
    animation->mChannels[i] = channel;
  }
  hips->addChildren(static_cast<unsigned>(parts.size()), parts.data());
  std::vector<aiNode*> top = {hips, holder};
  root->addChildren(2, top.data());
  scene->mRootNode = root;
  scene->mNumAnimations = 1;
  scene->mAnimations = new aiAnimation* [1] { animation };
  return scene;
}

// The number of joints of the skin; 0: the scene cannot be written.
std::size_t NumJoints(const aiScene& scene, std::vector<std::string>* remarks) {
  const Result<std::string> glb = WriteModel(scene, remarks);
  EXPECT_TRUE(glb.ok()) << glb.status().ToString();
  if (!glb.ok()) return 0;
  std::uint32_t length = 0;
  std::memcpy(&length, glb->data() + 12, sizeof length);
  return nlohmann::json::parse(glb->substr(20, length))["skins"][0]["joints"].size();
}

TEST(ModelWriter, RigidPartsThatMoveAreJoints) {
  std::vector<std::string> remarks;
  EXPECT_EQ(NumJoints(*MakeScene(2, 0.01f), &remarks), 3u);
  EXPECT_EQ(NumJoints(*MakeScene(2, 0.0f, 0.01f), &remarks), 3u);
  EXPECT_THAT(remarks, Not(Contains(HasSubstr("rigid parts"))));
}

// Exporters bake channels for nodes that nobody has animated, and round their numbers.
TEST(ModelWriter, ChannelsThatNeverLeaveTheRestMoveNothing) {
  std::vector<std::string> remarks;
  EXPECT_EQ(NumJoints(*MakeScene(2, 0.0f), &remarks), 1u);
  EXPECT_EQ(NumJoints(*MakeScene(2, 1e-5f, 1e-5f), &remarks), 1u);
  EXPECT_EQ(NumJoints(*MakeScene(wrinkle::kMaxJoints, 0.0f), &remarks), 1u);
  EXPECT_THAT(remarks, Not(Contains(HasSubstr("rigid parts"))));
}

TEST(ModelWriter, RigidPartsGiveWayToTheJointsOfBones) {
  std::vector<std::string> remarks;
  EXPECT_EQ(NumJoints(*MakeScene(wrinkle::kMaxJoints - 1, 1.0f), &remarks), 1024u);
  EXPECT_THAT(remarks, Not(Contains(HasSubstr("rigid parts"))));
  EXPECT_EQ(NumJoints(*MakeScene(wrinkle::kMaxJoints, 1.0f), &remarks), 1u);
  EXPECT_THAT(remarks, Contains(HasSubstr("some rigid parts do not move by themselves, because a "
                                          "skeleton has at most 1024 joints")));
}

}  // namespace
}  // namespace furrow::authoring
