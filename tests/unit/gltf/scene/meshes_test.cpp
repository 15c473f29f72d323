// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/meshes.h"

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

}  // namespace
}  // namespace furrow::gltf
