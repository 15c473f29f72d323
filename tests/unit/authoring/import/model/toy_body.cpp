// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/authoring/import/model/toy_body.h"

#include <array>
#include <filesystem>
#include <memory>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "base/files.h"
#include "character/mesh/tangents.h"
#include "character/package/package.h"
#include "tests/temporary_folder.h"

namespace furrow::authoring {
namespace {

struct ToyJoint {
  const char* name;
  int parent;
  glm::vec3 at;  // model space
};

constexpr float kArm = 1.4f;
const std::array<ToyJoint, 19> kJoints = {{{"hips", -1, {0, 0.95f, 0}},
                                           {"spine", 0, {0, 1.1f, 0}},
                                           {"chest", 1, {0, 1.25f, 0}},
                                           {"neck", 2, {0, 1.45f, 0}},
                                           {"head", 3, {0, 1.55f, 0}},
                                           {"leftUpperArm", 2, {0.18f, kArm, 0}},
                                           {"leftLowerArm", 5, {0.45f, kArm, 0}},
                                           {"leftHand", 6, {0.7f, kArm, 0}},
                                           {"rightUpperArm", 2, {-0.18f, kArm, 0}},
                                           {"rightLowerArm", 8, {-0.45f, kArm, 0}},
                                           {"rightHand", 9, {-0.7f, kArm, 0}},
                                           {"leftUpperLeg", 0, {0.1f, 0.9f, 0}},
                                           {"leftLowerLeg", 11, {0.1f, 0.5f, 0}},
                                           {"leftFoot", 12, {0.1f, 0.08f, 0}},
                                           {"leftToes", 13, {0.1f, 0.05f, 0.12f}},
                                           {"rightUpperLeg", 0, {-0.1f, 0.9f, 0}},
                                           {"rightLowerLeg", 15, {-0.1f, 0.5f, 0}},
                                           {"rightFoot", 16, {-0.1f, 0.08f, 0}},
                                           {"rightToes", 17, {-0.1f, 0.05f, 0.12f}}}};

// The six faces of a box. Each face has its own cell of the picture.
void AddBox(int joint, const glm::vec3& centre, float half, character::Mesh* mesh) {
  constexpr int kCells = 11;  // per side: 121 cells for 114 faces
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const float side = face % 2 == 0 ? 1.0f : -1.0f;
    const int cell = joint * 6 + face;
    const glm::vec2 corner(static_cast<float>(cell % kCells), static_cast<float>(cell / kCells));
    const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
    for (int k = 0; k < 4; ++k) {
      const float a = k == 1 || k == 2 ? 1.0f : -1.0f;
      const float b = k >= 2 ? 1.0f : -1.0f;
      character::Vertex vertex;
      glm::vec3 offset(0.0f);
      offset[axis] = side;
      offset[(axis + 1) % 3] = side * a;
      offset[(axis + 2) % 3] = b;
      vertex.position = centre + half * offset;
      vertex.normal = glm::vec3(0.0f);
      vertex.normal[axis] = side;
      vertex.uv = (corner + 0.1f + 0.8f * glm::vec2(a * 0.5f + 0.5f, b * 0.5f + 0.5f)) / 11.0f;
      const int parent = kJoints[joint].parent;
      const bool shared = parent >= 0 && offset.y > 0.0f;
      vertex.joints[0] = static_cast<std::uint16_t>(joint);
      vertex.joints[1] = static_cast<std::uint16_t>(shared ? parent : 0);
      vertex.skin_weights[0] = shared ? 0.75f : 1.0f;
      vertex.skin_weights[1] = shared ? 0.25f : 0.0f;
      mesh->vertices.push_back(vertex);
    }
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh->indices.push_back(first + i);
  }
}

// Removes the tails of joints: they are metadata, which assimp reads but cannot copy.
void DropMetadata(aiNode* node) {
  delete node->mMetaData;
  node->mMetaData = nullptr;
  for (unsigned c = 0; c < node->mNumChildren; ++c) DropMetadata(node->mChildren[c]);
}

// assimp 5.2 writes the ticks of an animation as if they were seconds.
void SetTicksToSeconds(aiAnimation* animation) {
  const double seconds = 1.0 / animation->mTicksPerSecond;
  const auto scale = [seconds](auto* keys, unsigned count) {
    for (unsigned k = 0; k < count; ++k) keys[k].mTime *= seconds;
  };
  for (unsigned c = 0; c < animation->mNumChannels; ++c) {
    aiNodeAnim& channel = *animation->mChannels[c];
    scale(channel.mPositionKeys, channel.mNumPositionKeys);
    scale(channel.mRotationKeys, channel.mNumRotationKeys);
    scale(channel.mScalingKeys, channel.mNumScalingKeys);
  }
  animation->mDuration *= seconds;
  animation->mTicksPerSecond = 1.0;
}

}  // namespace

character::Character ToyBody() {
  character::Character body;
  body.name = "toy";
  std::vector<wrinkle::JointDesc> joints;
  for (const ToyJoint& joint : kJoints) {
    const glm::vec3 above = joint.parent < 0 ? glm::vec3(0.0f) : kJoints[joint.parent].at;
    joints.push_back({joint.name, joint.parent, {joint.at - above}, {}});
  }
  body.skeleton = *wrinkle::Skeleton::Create(std::move(joints));
  for (const glm::mat4& rest : body.skeleton.rest_model()) {
    body.inverse_bind_matrices.push_back(glm::inverse(rest));
  }
  character::Mesh mesh;
  mesh.name = "skin";
  mesh.material = 0;
  for (std::size_t j = 0; j < kJoints.size(); ++j) {
    const bool head = kJoints[j].name == std::string_view("head");
    AddBox(static_cast<int>(j), kJoints[j].at + glm::vec3(0, head ? 0.07f : 0.0f, 0),
           head ? 0.08f : 0.05f, &mesh);
  }
  character::paint::ComputeTangents(mesh.vertices, mesh.indices);
  body.meshes.push_back(std::move(mesh));
  body.materials.push_back({.name = "skin", .kind = character::Material::Kind::kSkin});
  body.materials.back().base_colour = {0.5f, 0.25f, 0.125f, 1.0f};
  return body;
}

rig::SkeletonMaps VrmMaps() {
  return *rig::SkeletonMaps::Load(FURROW_SOURCE_DIR "/rig/skeleton_maps/vrm.json");
}

std::string GlbOf(const character::Character& character) {
  const TemporaryFolder folder;
  EXPECT_TRUE(character::SaveCharacterGlb(character, folder / "toy.glb").ok());
  return *ReadFile(folder / "toy.glb", 64u << 20);
}

std::string ConvertByAssimp(std::string_view glb, const std::string& format) {
  Assimp::Importer importer;
  (void)importer.ReadFileFromMemory(glb.data(), glb.size(), 0, "glb");
  const std::unique_ptr<aiScene> scene(importer.GetOrphanedScene());
  if (scene == nullptr) return {};
  DropMetadata(scene->mRootNode);
  for (unsigned a = 0; a < scene->mNumAnimations; ++a) SetTicksToSeconds(scene->mAnimations[a]);
  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = exporter.ExportToBlob(scene.get(), format);
  if (blob == nullptr) return {};
  return {static_cast<const char*>(blob->data), blob->size};
}

}  // namespace furrow::authoring
