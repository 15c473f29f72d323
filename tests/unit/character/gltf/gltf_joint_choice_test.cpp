// SPDX-License-Identifier: Apache-2.0
#include "character/gltf/gltf_joint_choice.h"

#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "character/package/package.h"
#include "tests/unit/gltf/gltf_testing.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::character {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A body of two joints, "hips" and "head", below "armature". Mesh 0 is skinned, mesh 1 a triangle
// around its origin. Tests add nodes below the head.
struct Avatar {
  Avatar() {
    gltf.json["nodes"] = {{{"name", "armature"}, {"children", {1, 3}}},
                          {{"name", "hips"}, {"translation", {0, 1, 0}}, {"children", {2}}},
                          {{"name", "head"}, {"translation", {0, 1, 0}}},
                          {{"name", "body"}, {"mesh", 0}, {"skin", 0}}};
    gltf.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", Binds({1, 2})}}};
    const int joints = gltf.AddAccessor(
        std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 5121, 4);
    const int weights = gltf.AddFloats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    gltf.json["meshes"] = {
        {{"primitives",
          {{{"attributes",
             {{"POSITION", Triangle()}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}}}}}},
        {{"primitives", {{{"attributes", {{"POSITION", Triangle()}}}}}}}};
  }

  // Inverse bind matrices of joints at these heights.
  int Binds(const std::vector<float>& heights) {
    std::vector<float> numbers;
    for (const float height : heights) {
      const glm::mat4 bind = glm::translate(glm::mat4(1.0f), glm::vec3(0, -height, 0));
      numbers.insert(numbers.end(), glm::value_ptr(bind), glm::value_ptr(bind) + 16);
    }
    return gltf.AddFloats(numbers, "MAT4");
  }

  int Triangle() {
    const int position = gltf.AddFloats({-1, -1, 0, 1, -1, 0, 0, 1, 0}, "VEC3");
    gltf.json["accessors"][static_cast<std::size_t>(position)]["min"] = {-1, -1, 0};
    gltf.json["accessors"][static_cast<std::size_t>(position)]["max"] = {1, 1, 0};
    return position;
  }

  // Adds a node below node `parent` and returns its index.
  int Add(int parent, json node) {
    const std::size_t index = gltf.json["nodes"].size();
    gltf.json["nodes"].push_back(std::move(node));
    gltf.json["nodes"][static_cast<std::size_t>(parent)]["children"].push_back(index);
    return static_cast<int>(index);
  }

  void Move(int node, const char* path = "rotation") {
    // No reader of characters needs the keys.
    gltf.AddChannel(node, path, "LINEAR", 9999, 9999);
  }

  [[nodiscard]] Character Read(const ReadOptions& options = {}) const {
    auto character = ParseCharacter(gltf.Glb(), ".", options);
    EXPECT_TRUE(character.ok()) << character.status().ToString();
    return character.ok() ? std::move(*character) : Character();
  }

  gltf::HandMadeGltf gltf;
};

// The name of the joint that the last mesh of a character follows.
std::string Followed(const Character& character) {
  return character.skeleton.joint_names()[character.meshes.back().vertices[0].joints[0]];
}

// Where a vertex of the last mesh is drawn at rest.
glm::vec3 Drawn(const Character& character, std::size_t vertex) {
  const Vertex& v = character.meshes.back().vertices[vertex];
  return glm::vec3(character.skeleton.rest_model()[v.joints[0]] *
                   character.inverse_bind_matrices[v.joints[0]] * glm::vec4(v.position, 1.0f));
}

constexpr int kHead = 2;

TEST(GltfJointChoice, RigidPartsThatNothingMovesFollowTheirJoint) {
  Avatar avatar;
  avatar.Add(kHead, {{"name", "hat"}, {"mesh", 1}});
  const Character character = avatar.Read();
  EXPECT_THAT(character.skeleton.joint_names(), ElementsAre("armature", "hips", "head"));
  EXPECT_EQ(Followed(character), "head");
}

TEST(GltfJointChoice, RigidPartsThatAnAnimationMovesAreJoints) {
  Avatar avatar;
  const int socket = avatar.Add(kHead, {{"name", "socket"}});
  const int eye = avatar.Add(socket, {{"name", "eye"}, {"translation", {3, 0, 0}}});
  avatar.Add(eye, {{"name", "ball"}, {"mesh", 1}});
  avatar.Move(eye);
  const Character character = avatar.Read();
  EXPECT_THAT(character.skeleton.joint_names(),
              ElementsAre("armature", "hips", "head", "socket", "eye"));
  EXPECT_EQ(Followed(character), "eye");
  EXPECT_LT(glm::distance(Drawn(character, 1), glm::vec3(4, 1, 0)), 1e-5f);
  EXPECT_THAT(character.warnings, IsEmpty());
}

// A prop below the scene's root, which is above the joints.
TEST(GltfJointChoice, RigidPartsMayHangOnAncestorsOfJoints) {
  Avatar avatar;
  avatar.Move(avatar.Add(0, {{"name", "sword"}, {"mesh", 1}}), "scale");
  EXPECT_EQ(Followed(avatar.Read()), "sword");
}

TEST(GltfJointChoice, OtherMovingNodesAreNoJoints) {
  Avatar avatar;
  avatar.Move(avatar.Add(kHead, {{"name", "helper"}}));  // without a mesh
  avatar.Move(avatar.Add(kHead, {{"name", "hair"}, {"mesh", 0}, {"skin", 0}}));
  avatar.Move(avatar.Add(kHead, {{"name", "face"}, {"mesh", 1}}), "weights");
  avatar.Move(3);     // skins ignore it
  avatar.Move(4711);  // does not exist
  avatar.gltf.json["nodes"].push_back({{"name", "car"}, {"mesh", 1}});
  avatar.Move(static_cast<int>(avatar.gltf.json["nodes"].size()) - 1);  // elsewhere
  EXPECT_THAT(avatar.Read().skeleton.joint_names(), ElementsAre("armature", "hips", "head"));
}

TEST(GltfJointChoice, FaultsInAnimationsDoNoHarm) {
  Avatar avatar;
  avatar.gltf.json["animations"] = {
      1, {{"channels", 2}}, {{"channels", {3, {{"target", 4}}, {{"target", {{"node", -1}}}}}}}};
  EXPECT_EQ(avatar.Read().skeleton.num_joints(), 3);
}

TEST(GltfJointChoice, HumanBonesOfVrmAreJoints) {
  Avatar avatar;
  const int eye = avatar.Add(kHead, {{"name", "a"}, {"mesh", 1}});
  avatar.Add(kHead, {{"name", "hat"}, {"mesh", 1}});
  avatar.gltf.json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"] = {
      {"head", {{"node", kHead}}}, {"leftEye", {{"node", eye}}}};
  const Character character = avatar.Read();
  EXPECT_THAT(character.skeleton.joint_names(), ElementsAre("armature", "hips", "head", "a"));
  EXPECT_EQ(character.roles[3], wrinkle::JointRole::kLeftEye);
}

TEST(GltfJointChoice, NodesWithRolesAreJoints) {
  Avatar avatar;
  avatar.Add(kHead, {{"name", "a"}, {"mesh", 1}, {"extras", {{"furrow_role", "rightEye"}}}});
  const Character character = avatar.Read();
  EXPECT_THAT(character.roles,
              ElementsAre(wrinkle::JointRole::kNone, wrinkle::JointRole::kNone,
                          wrinkle::JointRole::kNone, wrinkle::JointRole::kRightEye));
}

const ReadOptions kEyes = {.is_eye_name = [](const std::string& name) { return name == "eye_l"; }};

TEST(GltfJointChoice, EyesAreKnownByTheirNames) {
  Avatar avatar;
  avatar.Add(kHead, {{"name", "eye_l"}, {"mesh", 1}});
  avatar.Add(kHead, {{"name", "eye_r"}, {"mesh", 1}});
  EXPECT_THAT(avatar.Read(kEyes).skeleton.joint_names(),
              ElementsAre("armature", "hips", "head", "eye_l"));
  EXPECT_EQ(avatar.Read().skeleton.num_joints(), 3) << "no name is known without options";
}

// Modellers leave the origin of a part at the feet or at the joint above. Such an eye would turn
// about it.
TEST(GltfJointChoice, EyesHoldTheirOrigin) {
  Avatar avatar;
  const int eye = avatar.Add(kHead, {{"name", "eye_l"}});
  avatar.Add(eye, {{"name", "ball"}, {"mesh", 1}, {"translation", {0, 1.5f, 0}}});
  EXPECT_EQ(avatar.Read(kEyes).skeleton.num_joints(), 3);
  avatar.gltf.json["nodes"].back()["translation"] = {0, 0.5f, 0};
  EXPECT_EQ(avatar.Read(kEyes).skeleton.num_joints(), 4);
}

// The mesh of an eye often has the name of the joint that moves it.
TEST(GltfJointChoice, EyesOfOneNameAreOneJoint) {
  Avatar avatar;
  avatar.gltf.json["nodes"][kHead]["name"] = "eye_l";
  avatar.Add(kHead, {{"name", "eye_l"}, {"mesh", 1}});
  const Character character = avatar.Read(kEyes);
  EXPECT_EQ(character.skeleton.num_joints(), 3);
  EXPECT_THAT(character.warnings, IsEmpty());
}

TEST(GltfJointChoice, RigidPartsGiveWayToTheJointsOfSkins) {
  Avatar avatar;
  for (int i = 0; i < wrinkle::kMaxJoints - 3; ++i) {
    avatar.Move(avatar.Add(kHead, {{"name", "coin_" + std::to_string(i)}, {"mesh", 1}}));
  }
  EXPECT_EQ(avatar.Read().skeleton.num_joints(), wrinkle::kMaxJoints);
  avatar.Move(avatar.Add(kHead, {{"name", "last"}, {"mesh", 1}}));
  const Character character = avatar.Read();
  EXPECT_EQ(character.skeleton.num_joints(), 3);
  EXPECT_THAT(character.warnings, ElementsAre(HasSubstr("some rigid parts do not move")));
}

}  // namespace
}  // namespace furrow::character
