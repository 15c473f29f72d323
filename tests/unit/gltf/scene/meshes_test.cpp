// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/meshes.h"

#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gltf/limits.h"
#include "tests/unit/gltf/gltf_testing.h"

namespace furrow::gltf {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// One triangle with `targets` morph targets.
HandMadeGltf Morphing(int targets) {
  HandMadeGltf gltf;
  const int positions = gltf.AddFloats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  json primitive = {{"attributes", {{"POSITION", positions}}}};
  for (int i = 0; i < targets; ++i) {
    primitive["targets"].push_back({{"POSITION", positions}, {"NORMAL", 7}});
  }
  gltf.json["meshes"] = {{{"name", "face"}, {"primitives", {primitive}}}};
  return gltf;
}

struct Meshes {
  std::vector<Mesh> meshes;
  std::vector<std::string> warnings;
  Status status;
};

Meshes MeshesOf(const HandMadeGltf& gltf) {
  const std::string glb = gltf.Glb();
  Result<Document> document = Document::Open(glb, {});
  if (!document.ok()) return {{}, {}, document.status()};
  Result<std::vector<Mesh>> meshes = ReadMeshes(&*document);
  if (!meshes.ok()) return {{}, {}, meshes.status()};
  return {std::move(*meshes), document->warnings(), {}};
}

TEST(Meshes, NameTheirMorphTargets) {
  HandMadeGltf gltf = Morphing(3);
  gltf.json["meshes"][0]["extras"]["targetNames"] = {"jawOpen", "", "smile"};
  const Meshes read = MeshesOf(gltf);
  ASSERT_TRUE(read.status.ok()) << read.status.ToString();
  EXPECT_THAT(read.meshes[0].morph_target_names, ElementsAre("jawOpen", "face.1", "smile"));
  EXPECT_THAT(read.warnings, IsEmpty());
  const std::vector<MorphTarget>& targets = read.meshes[0].primitives[0].morph_targets;
  ASSERT_EQ(targets.size(), 3u);
  EXPECT_EQ(targets[1].position, 0);
  EXPECT_EQ(targets[1].normal, 7);
  EXPECT_EQ(targets[1].tangent, kNone);
}

TEST(Meshes, WithoutANameHaveThatOfTheirNode) {
  HandMadeGltf gltf = Morphing(1);
  EXPECT_EQ(MeshesOf(gltf).meshes[0].name, "face");
  gltf.json["meshes"][0].erase("name");
  gltf.json["nodes"] = {{{"name", "empty"}}, {{"name", "Teeth_Geo"}, {"mesh", 0}}};
  EXPECT_EQ(MeshesOf(gltf).meshes[0].name, "Teeth_Geo");
  gltf.json["nodes"] = {{{"mesh", 0}}, {{"name", "Teeth_Geo"}, {"children", {0}}}};
  EXPECT_EQ(MeshesOf(gltf).meshes[0].name, "Teeth_Geo");
  gltf.json["nodes"] = {{{"mesh", 0}}};
  EXPECT_EQ(MeshesOf(gltf).meshes[0].name, "mesh_0");
}

TEST(Meshes, NumberRepeatedTargetNames) {
  HandMadeGltf gltf = Morphing(4);
  gltf.json["meshes"][0]["extras"]["targetNames"] = {"a", "a", "b", "a"};
  const Meshes read = MeshesOf(gltf);
  ASSERT_TRUE(read.status.ok()) << read.status.ToString();
  EXPECT_THAT(read.meshes[0].morph_target_names, ElementsAre("a", "a_2", "b", "a_3"));
  EXPECT_THAT(read.warnings, ElementsAre(HasSubstr("2 morph targets repeat a name")));
}

TEST(Meshes, CutLongTargetNames) {
  HandMadeGltf gltf = Morphing(1);
  gltf.json["meshes"][0]["extras"]["targetNames"] = {std::string(1000, 'x')};
  EXPECT_EQ(MeshesOf(gltf).meshes[0].morph_target_names[0].size(), kMaxNameBytes);
}

TEST(Meshes, LimitTheNumberOfTargets) {
  EXPECT_TRUE(MeshesOf(Morphing(kMaxMorphTargets)).status.ok());
  EXPECT_EQ(MeshesOf(Morphing(kMaxMorphTargets + 1)).status.code(), StatusCode::kLimit);
  HandMadeGltf many = Morphing(kMaxMorphTargets);
  const json mesh = many.json["meshes"][0];
  for (std::size_t i = 0; i < kMaxAllMorphTargets / kMaxMorphTargets; ++i) {
    many.json["meshes"].push_back(mesh);
  }
  EXPECT_EQ(MeshesOf(many).status.code(), StatusCode::kLimit);
}

// An eye with its ball, which is scaled and moved, and with a skinned mesh.
HandMadeGltf Eye() {
  HandMadeGltf gltf;
  const int position = gltf.AddFloats({0, 0, 0, 1, 0, 0, 0, 2, 3}, "VEC3");
  gltf.json["accessors"][0]["min"] = {0, 0, 0};
  gltf.json["accessors"][0]["max"] = {1, 2, 3};
  gltf.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", position}}}}}}}};
  gltf.json["skins"] = {{{"joints", {0}}}};
  gltf.json["nodes"] = {
      {{"translation", {50, 0, 0}}, {"children", {1, 2}}},
      {{"mesh", 0}, {"translation", {0, 10, 0}}, {"scale", {-2, 1, 1}}},
      {{"mesh", 0}, {"skin", 0}, {"translation", {0, -99, 0}}},
  };
  return gltf;
}

std::optional<Bounds> BoundsIn(const HandMadeGltf& gltf, int node) {
  const std::string bytes = gltf.Glb();
  auto document = Document::Open(bytes, {});
  EXPECT_TRUE(document.ok()) << document.status().ToString();
  if (!document.ok()) return std::nullopt;
  const auto forest = ReadNodes(&*document);
  EXPECT_TRUE(forest.ok()) << forest.status().ToString();
  return forest.ok() ? BoundsOfPart(*document, *forest, node) : std::nullopt;
}

TEST(PartBounds, AreThoseOfRigidMeshesInTheNodesSpace) {
  const auto bounds = BoundsIn(Eye(), 0);
  ASSERT_TRUE(bounds);
  EXPECT_EQ(bounds->low, glm::vec3(-2, 10, 0));
  EXPECT_EQ(bounds->high, glm::vec3(0, 12, 3));
  EXPECT_EQ(BoundsIn(Eye(), 1)->high, glm::vec3(1, 2, 3)) << "its own transform does not count";
  EXPECT_FALSE(BoundsIn(Eye(), 2)) << "the mesh has a skin";
}

TEST(PartBounds, NeedBoundsInTheFile) {
  HandMadeGltf without = Eye();
  without.json["accessors"][0].erase("min");
  EXPECT_FALSE(BoundsIn(without, 0));
  HandMadeGltf normalised = Eye();
  normalised.json["accessors"][0]["normalized"] = true;
  EXPECT_FALSE(BoundsIn(normalised, 0));
  HandMadeGltf huge = Eye();
  huge.json["accessors"][0]["max"] = {1e300, 1, 1};
  EXPECT_FALSE(BoundsIn(huge, 0));
  HandMadeGltf missing = Eye();
  missing.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 7;
  EXPECT_FALSE(BoundsIn(missing, 0));
}

}  // namespace
}  // namespace furrow::gltf
