// SPDX-License-Identifier: Apache-2.0
#include "character/gltf/gltf_skeleton.h"

#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <gtest/gtest.h>

#include "character/package/package.h"
#include "tests/unit/gltf/gltf_testing.h"

namespace furrow::character {
namespace {

using nlohmann::json;

// Two meshes of one triangle each, bound to two joints by a skin each. The joints rest at y = 1 and
// y = 2; `binds` has the inverse bind matrices of each skin.
gltf::HandMadeGltf TwoSkins(const std::vector<std::vector<glm::mat4>>& binds) {
  gltf::HandMadeGltf gltf;
  gltf.json["nodes"] = {{{"name", "hip"}, {"translation", {0, 1, 0}}, {"children", {1}}},
                        {{"name", "chest"}, {"translation", {0, 1, 0}}}};
  const int position = gltf.AddFloats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int joints = gltf.AddAccessor(std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0},
                                      "VEC4", 5121, 4);
  const int weights = gltf.AddFloats({1, 0, 0, 0, 0, 1, 0, 0, 0.5f, 0.5f, 0, 0}, "VEC4");
  gltf.json["meshes"] = {
      {{"primitives",
        {{{"attributes",
           {{"POSITION", position}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}}}}}}};
  for (std::size_t s = 0; s < binds.size(); ++s) {
    std::vector<float> numbers;
    for (const glm::mat4& bind : binds[s]) {
      numbers.insert(numbers.end(), glm::value_ptr(bind), glm::value_ptr(bind) + 16);
    }
    gltf.json["skins"].push_back(
        {{"joints", {0, 1}}, {"inverseBindMatrices", gltf.AddFloats(numbers, "MAT4")}});
    gltf.json["nodes"].push_back({{"mesh", 0}, {"skin", s}});
  }
  return gltf;
}

glm::mat4 Down(float metres) { return glm::translate(glm::mat4(1.0f), glm::vec3(0, -metres, 0)); }

// Where a vertex is drawn if the chest is raised by 1 m.
glm::vec3 Drawn(const Character& character, std::size_t mesh, std::size_t vertex) {
  const Vertex& v = character.meshes[mesh].vertices[vertex];
  glm::vec4 sum(0.0f);
  for (int i = 0; i < 4; ++i) {
    glm::mat4 model = character.skeleton.rest_model()[v.joints[i]];
    if (v.joints[i] == 1) model = Down(-1.0f) * model;
    sum += v.skin_weights[i] *
           (model * character.inverse_bind_matrices[v.joints[i]] * glm::vec4(v.position, 1.0f));
  }
  return glm::vec3(sum);
}

// What glTF demands: joint matrix times the skin's own inverse bind matrix.
glm::vec3 Due(const std::vector<glm::mat4>& binds, std::size_t vertex) {
  const glm::vec4 p = vertex == 0   ? glm::vec4(0, 0, 0, 1)
                      : vertex == 1 ? glm::vec4(1, 0, 0, 1)
                                    : glm::vec4(0, 1, 0, 1);
  const glm::vec4 hip = Down(-1.0f) * binds[0] * p;
  const glm::vec4 chest = Down(-3.0f) * binds[1] * p;
  const float share = vertex == 0 ? 0.0f : vertex == 1 ? 1.0f : 0.5f;
  return glm::vec3(glm::mix(hip, chest, share));
}

void ExpectDrawnAsDue(const std::vector<std::vector<glm::mat4>>& binds) {
  const auto character = ParseCharacter(TwoSkins(binds).Glb(), ".");
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  for (std::size_t m = 0; m < binds.size(); ++m) {
    for (std::size_t v = 0; v < 3; ++v) {
      EXPECT_LT(glm::distance(Drawn(*character, m, v), Due(binds[m], v)), 1e-5f) << m << " " << v;
    }
  }
}

TEST(GltfSkeleton, OneBindKeepsItsVertices) {
  const std::vector<glm::mat4> bind = {Down(1), Down(2)};
  ExpectDrawnAsDue({bind, bind});
  const auto character = ParseCharacter(TwoSkins({bind, bind}).Glb(), ".");
  EXPECT_EQ(character->meshes[0].vertices[1].position, glm::vec3(1, 0, 0));
}

TEST(GltfSkeleton, SkinsMayBindOneJointDifferently) {
  const glm::mat4 small = glm::scale(glm::mat4(1.0f), glm::vec3(0.01f));
  const glm::mat4 aside = glm::translate(glm::mat4(1.0f), glm::vec3(3, 0, 0));
  ExpectDrawnAsDue({{Down(1), Down(2)}, {Down(1) * aside, Down(2) * aside}});
  ExpectDrawnAsDue({{Down(1) * small, Down(2) * small}, {Down(1) * aside, Down(2) * aside}});
}

TEST(GltfSkeleton, HiddenScalesMoveToTheVertices) {
  const glm::mat4 small = glm::scale(glm::mat4(1.0f), glm::vec3(0.01f));
  const std::vector<glm::mat4> bind = {Down(1) * small, Down(2) * small};
  ExpectDrawnAsDue({bind});
  const auto character = ParseCharacter(TwoSkins({bind}).Glb(), ".");
  ASSERT_TRUE(character.ok());
  EXPECT_LT(glm::distance(character->meshes[0].vertices[1].position, glm::vec3(0.01f, 0, 0)),
            1e-6f);
}

// A hat on the chest, which the skin binds 1 m above its rest pose.
TEST(GltfSkeleton, RigidMeshesRestAtTheirNodes) {
  gltf::HandMadeGltf gltf = TwoSkins({{Down(1), Down(3)}});
  gltf.json["meshes"].push_back(gltf.json["meshes"][0]);
  gltf.json["nodes"][1]["children"] = {3};
  gltf.json["nodes"].push_back({{"mesh", 1}, {"translation", {0, 0, 5}}});
  const auto character = ParseCharacter(gltf.Glb(), ".");
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  const Vertex& vertex = character->meshes[1].vertices[1];
  ASSERT_EQ(vertex.joints[0], 1);
  const glm::mat4 skin = character->skeleton.rest_model()[1] * character->inverse_bind_matrices[1];
  EXPECT_LT(glm::distance(glm::vec3(skin * glm::vec4(vertex.position, 1)), glm::vec3(1, 2, 5)),
            1e-5f);
  EXPECT_LT(glm::distance(vertex.position, glm::vec3(1, 3, 5)), 1e-5f);
}

// Bound in another pose than at rest: at rest, it is exact.
TEST(GltfSkeleton, ConflictingPosesMeetAtRest) {
  const std::vector<std::vector<glm::mat4>> binds = {{Down(1), Down(2)}, {Down(1), Down(2.5f)}};
  const auto character = ParseCharacter(TwoSkins(binds).Glb(), ".");
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  EXPECT_LT(glm::distance(character->meshes[1].vertices[1].position, glm::vec3(1, -0.5f, 0)),
            1e-6f);
  EXPECT_LT(glm::distance(character->meshes[1].vertices[2].position, glm::vec3(0, 0.75f, 0)),
            1e-6f);
}

}  // namespace
}  // namespace furrow::character
