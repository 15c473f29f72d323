// SPDX-License-Identifier: Apache-2.0
#include "character/gltf/gltf_mesh.h"

#include <cstdint>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "character/package/package.h"
#include "tests/unit/gltf/gltf_testing.h"

namespace furrow::character {
namespace {

using gltf::HandMadeGltf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A node with a mesh of five vertices on a zigzag. `mode`: glTF's, as in `primitive.mode`.
HandMadeGltf Zigzag(int mode) {
  HandMadeGltf gltf;
  gltf.json["nodes"] = {{{"name", "head"}, {"mesh", 0}}};
  const int position = gltf.AddFloats({0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0}, "VEC3");
  gltf.json["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", position}}}, {"mode", mode}}}}}};
  return gltf;
}

TEST(GltfMesh, StripsBecomeTriangles) {
  const auto character = ParseCharacter(Zigzag(5).Glb(), ".");
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  EXPECT_THAT(character->meshes[0].indices, ElementsAre(0, 1, 2, 1, 3, 2, 2, 3, 4));
  // All triangles face the same way.
  for (const Vertex& vertex : character->meshes[0].vertices) EXPECT_EQ(vertex.normal.z, -1.0f);
}

TEST(GltfMesh, FansBecomeTriangles) {
  const auto character = ParseCharacter(Zigzag(6).Glb(), ".");
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  EXPECT_THAT(character->meshes[0].indices, ElementsAre(0, 1, 2, 0, 2, 3, 0, 3, 4));
}

TEST(GltfMesh, PointsAndLinesAreLeftOut) {
  HandMadeGltf gltf = Zigzag(5);
  auto& primitives = gltf.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[1]["mode"] = 1;
  const auto character = ParseCharacter(gltf.Glb(), ".");
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  EXPECT_EQ(character->meshes.size(), 1u);
  EXPECT_THAT(character->warnings,
              ElementsAre(HasSubstr("primitives[1].mode: points and lines are left out")));
}

TEST(GltfMesh, OnlyLinesAreNoCharacter) {
  const Status status = ParseCharacter(Zigzag(1).Glb(), ".").status();
  EXPECT_EQ(status.code(), StatusCode::kSchema);
  EXPECT_THAT(status.todo(), HasSubstr("as polygons"));
}

// The mesh has two sets of UVs. The material's texture uses the second.
TEST(GltfMesh, TheMaterialChoosesTheUvs) {
  HandMadeGltf gltf = Zigzag(5);
  auto& primitive = gltf.json["meshes"][0]["primitives"][0];
  const std::vector<float> zero(10, 0.0f), quarter(10, 0.25f);
  primitive["attributes"]["TEXCOORD_0"] = gltf.AddAccessor(zero, "VEC2", 5126, 2);
  primitive["attributes"]["TEXCOORD_1"] = gltf.AddAccessor(quarter, "VEC2", 5126, 2);
  primitive["material"] = 0;
  gltf.json["images"] = {{{"uri", "data:image/png;base64,AAAA"}}};
  gltf.json["textures"] = {{{"source", 0}}};
  gltf.json["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}}}};
  const auto character = ParseCharacter(gltf.Glb(), ".", {.lenient = true});
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  EXPECT_THAT(character->warnings, IsEmpty());
  EXPECT_EQ(character->meshes[0].vertices[3].uv, glm::vec2(0.25f));
  primitive["attributes"].erase("TEXCOORD_1");
  const auto without = ParseCharacter(gltf.Glb(), ".", {.lenient = true});
  ASSERT_TRUE(without.ok()) << without.status().ToString();
  EXPECT_EQ(without->meshes[0].vertices[3].uv, glm::vec2(0.0f));
}

}  // namespace
}  // namespace furrow::character
