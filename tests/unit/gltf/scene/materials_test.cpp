// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/materials.h"

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/gltf/gltf_testing.h"

namespace furrow::gltf {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct MaterialsRead {
  std::vector<Material> materials;
  std::vector<std::string> warnings;
  Status status;
};

// A material whose texture names its image by this extension only.
MaterialsRead ReadExtension(const std::string& name) {
  HandMadeGltf gltf;
  gltf.AddFloats({0}, "SCALAR");
  gltf.json["images"] = {{{"uri", "a.png"}}, {{"uri", "b.webp"}}};
  gltf.json["textures"] = {{{"extensions", {{name, {{"source", 1}}}}}}};
  gltf.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  const std::string glb = gltf.Glb();
  Result<Document> document = Document::Open(glb, {});
  if (!document.ok()) return {{}, {}, document.status()};
  Result<std::vector<Material>> materials = ReadMaterials(&*document);
  if (!materials.ok()) return {{}, {}, materials.status()};
  return {std::move(*materials), document->warnings(), {}};
}

TEST(Materials, UseWebpImages) {
  const MaterialsRead read = ReadExtension("EXT_texture_webp");
  ASSERT_TRUE(read.status.ok()) << read.status.ToString();
  EXPECT_EQ(read.materials[0].base_colour_image, 1);
  EXPECT_THAT(read.warnings, IsEmpty());
}

TEST(Materials, WarnOfTexturesThatNobodyReads) {
  const MaterialsRead read = ReadExtension("KHR_texture_basisu");
  ASSERT_TRUE(read.status.ok()) << read.status.ToString();
  EXPECT_EQ(read.materials[0].base_colour_image, kNone);
  EXPECT_THAT(read.warnings, ElementsAre(HasSubstr("'KHR_texture_basisu' is not supported")));
}

// The materials of a VRM 0.x file with these MToon properties; only the first has a texture in
// glTF.
MaterialsRead ReadMToon(const json& properties) {
  HandMadeGltf gltf;
  gltf.AddFloats({0}, "SCALAR");
  gltf.json["images"] = {{{"uri", "a.png"}}, {{"uri", "b.png"}}};
  gltf.json["textures"] = {{{"source", 0}}, {{"source", 1}}};
  gltf.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}},
                            {{"name", "face"}}};
  gltf.json["extensionsUsed"] = {"VRM"};
  gltf.json["extensions"]["VRM"]["materialProperties"] = json::array({properties, properties});
  const std::string glb = gltf.Glb();
  Result<Document> document = Document::Open(glb, {});
  if (!document.ok()) return {{}, {}, document.status()};
  Result<std::vector<Material>> materials = ReadMaterials(&*document);
  if (!materials.ok()) return {{}, {}, materials.status()};
  return {std::move(*materials), document->warnings(), {}};
}

TEST(Materials, TakeMToonsTextureWhereGltfStatesNone) {
  const MaterialsRead read = ReadMToon(
      {{"shader", "VRM/MToon"},
       {"textureProperties", {{"_MainTex", 1}, {"_ShadeTexture", 0}}},
       {"vectorProperties", {{"_MainTex", {0.5, 0.25, 2, 0.5}}, {"_Color", {1, 1, 1, 1}}}}});
  ASSERT_TRUE(read.status.ok()) << read.status.ToString();
  EXPECT_EQ(read.materials[0].base_colour_image, 0);
  EXPECT_EQ(read.materials[0].uv_transform, UvTransform());
  EXPECT_EQ(read.materials[1].base_colour_image, 1);
  EXPECT_EQ(read.materials[1].uv_transform, (UvTransform{{0.5f, 0.25f}, 0.0f, {2, 0.5f}}));
}

// Material 0 has a texture of glTF's; material 1 states nothing.
TEST(Materials, TakeMToonsColourWhereGltfStatesNone) {
  const MaterialsRead read =
      ReadMToon({{"shader", "VRM/MToon"}, {"vectorProperties", {{"_Color", {0.5, 0, 7, 0.25}}}}});
  ASSERT_TRUE(read.status.ok()) << read.status.ToString();
  EXPECT_EQ(read.materials[0].base_colour, glm::vec4(1.0f));
  EXPECT_NEAR(read.materials[1].base_colour.r, 0.21404f, 1e-5f) << "sRGB";
  EXPECT_EQ(read.materials[1].base_colour.g, 0.0f);
  EXPECT_EQ(read.materials[1].base_colour.b, 1.0f);
  EXPECT_EQ(read.materials[1].base_colour.a, 0.25f) << "linear";
}

TEST(Materials, SurviveFaultyMToon) {
  for (const json& faulty :
       {json(), json(7), json::object(), json{{"textureProperties", 3}},
        json{{"textureProperties", {{"_MainTex", "a"}}}},
        json{{"textureProperties", {{"_MainTex", -1}}}},
        json{{"textureProperties", {{"_MainTex", 1}}}, {"vectorProperties", {{"_MainTex", {1}}}}},
        json{{"vectorProperties", {{"_Color", {"a", 0.5}}}}},
        json{{"vectorProperties", {{"_Color", 3}}}}}) {
    EXPECT_TRUE(ReadMToon(faulty).status.ok()) << faulty;
  }
  EXPECT_EQ(ReadMToon({{"textureProperties", {{"_MainTex", 9}}}}).status.code(),
            StatusCode::kSchema);
}

// One material whose base colour and normal texture have these transforms.
MaterialsRead ReadMaterial(const json& colour, const json& normal) {
  HandMadeGltf gltf;
  gltf.AddFloats({0}, "SCALAR");  // a buffer must not be empty
  gltf.json["images"] = {{{"uri", "a.png"}}};
  gltf.json["textures"] = {{{"source", 0}}};
  const auto texture = [](const json& transform) {
    json info = {{"index", 0}};
    if (!transform.is_null()) info["extensions"]["KHR_texture_transform"] = transform;
    return info;
  };
  gltf.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", texture(colour)}}},
                             {"normalTexture", texture(normal)}}};
  gltf.json["extensionsRequired"] = {"KHR_texture_transform"};
  const std::string glb = gltf.Glb();
  Result<Document> document = Document::Open(glb, {});
  if (!document.ok()) return {{}, {}, document.status()};
  Result<std::vector<Material>> materials = ReadMaterials(&*document);
  if (!materials.ok()) return {{}, {}, materials.status()};
  return {std::move(*materials), document->warnings(), {}};
}

TEST(UvTransform, ScalesThenTurnsThenMoves) {
  const UvTransform turn{.rotation = 1.5707963f};
  EXPECT_LT(glm::distance(turn.Apply({1, 0}), glm::vec2(0, -1)), 1e-6f);
  EXPECT_LT(glm::distance(turn.Apply({0, 1}), glm::vec2(1, 0)), 1e-6f);
  const UvTransform all{.offset = {0.5f, 0.25f}, .rotation = 1.5707963f, .scale = {2, 3}};
  EXPECT_LT(glm::distance(all.Apply({1, 1}), glm::vec2(3.5f, -1.75f)), 1e-6f);
}

TEST(Materials, ReadTheTextureTransform) {
  const json transform = {{"offset", {0.5, 0.25}}, {"scale", {2, 3}}, {"rotation", 0.125}};
  const MaterialsRead read = ReadMaterial(transform, transform);
  ASSERT_TRUE(read.status.ok()) << read.status.ToString();
  EXPECT_THAT(read.warnings, IsEmpty());
  EXPECT_EQ(read.materials[0].uv_transform, (UvTransform{{0.5f, 0.25f}, 0.125f, {2, 3}}));
}

TEST(Materials, WarnOfTransformsThatDiffer) {
  const MaterialsRead read = ReadMaterial({{"scale", {2, 2}}}, json());
  ASSERT_TRUE(read.status.ok()) << read.status.ToString();
  EXPECT_THAT(read.warnings, ElementsAre(HasSubstr("different KHR_texture_transform")));
  EXPECT_EQ(read.materials[0].uv_transform.scale, glm::vec2(2));
}

TEST(Materials, RejectInvalidTransforms) {
  EXPECT_EQ(ReadMaterial({{"scale", {1e200, 1}}}, json()).status.code(), StatusCode::kNonFinite);
  EXPECT_TRUE(ReadMaterial({{"scale", 5}, {"offset", {1}}}, {{"offset", {1}}}).status.ok());
}

TEST(Materials, UseOneSetOfUvs) {
  const MaterialsRead both = ReadMaterial({{"texCoord", 1}}, {{"texCoord", 1}});
  ASSERT_TRUE(both.status.ok()) << both.status.ToString();
  EXPECT_THAT(both.warnings, IsEmpty());
  EXPECT_EQ(both.materials[0].uv_set, 1);
  const MaterialsRead differ = ReadMaterial({{"texCoord", 1}}, json());
  ASSERT_TRUE(differ.status.ok()) << differ.status.ToString();
  EXPECT_EQ(differ.materials[0].uv_set, 1);
  EXPECT_GE(differ.materials[0].base_colour_image, 0);
  EXPECT_EQ(differ.materials[0].normal_image, kNone);
  EXPECT_THAT(differ.warnings,
              ElementsAre(HasSubstr("materials[0].normalTexture.texCoord: the texture uses "
                                    "TEXCOORD_0, the material's first texture TEXCOORD_1")));
}

// A material of the older workflow, and one that has both.
TEST(Materials, UseTheDiffuseColourOfSpecularGlossiness) {
  HandMadeGltf gltf;
  gltf.AddFloats({0}, "SCALAR");
  gltf.json["images"] = {{{"uri", "a.png"}}, {{"uri", "b.png"}}};
  gltf.json["textures"] = {{{"source", 0}}, {{"source", 1}}};
  gltf.json["extensionsRequired"] = {"KHR_materials_pbrSpecularGlossiness"};
  const json glossy = {{"KHR_materials_pbrSpecularGlossiness",
                        {{"diffuseFactor", {0.5, 0.25, 2.0, 1.0}},
                         {"glossinessFactor", 0.25},
                         {"diffuseTexture",
                          {{"index", 1},
                           {"texCoord", 1},
                           {"extensions", {{"KHR_texture_transform", {{"scale", {2, 3}}}}}}}}}}};
  gltf.json["materials"] = {
      {{"extensions", glossy}},
      {{"extensions", glossy}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  const std::string glb = gltf.Glb();
  Result<Document> document = Document::Open(glb, {});
  ASSERT_TRUE(document.ok()) << document.status().ToString();
  const Result<std::vector<Material>> materials = ReadMaterials(&*document);
  ASSERT_TRUE(materials.ok()) << materials.status().ToString();
  EXPECT_THAT(document->warnings(), IsEmpty());
  const Material& only = (*materials)[0];
  EXPECT_EQ(only.base_colour_image, 1);
  EXPECT_EQ(only.base_colour, glm::vec4(0.5f, 0.25f, 1.0f, 1.0f));
  EXPECT_EQ(only.roughness, 0.75f);
  EXPECT_EQ(only.uv_set, 1);
  EXPECT_EQ(only.uv_transform.scale, glm::vec2(2, 3));
  EXPECT_EQ((*materials)[1].base_colour_image, 0);
  EXPECT_EQ((*materials)[1].base_colour, glm::vec4(1.0f));
}

TEST(Materials, SurviveFaultySpecularGlossiness) {
  HandMadeGltf gltf;
  gltf.AddFloats({0}, "SCALAR");
  for (const json& faulty :
       {json(5), json{{"diffuseFactor", {"red"}}}, json{{"diffuseTexture", {{"index", "0"}}}},
        json{{"diffuseTexture", {{"index", 0}, {"extensions", 3}}}},
        json{{"diffuseTexture", {{"index", 7}}}}, json{{"diffuseFactor", {1e200}}}}) {
    gltf.json["materials"] = {{{"extensions", {{"KHR_materials_pbrSpecularGlossiness", faulty}}}}};
    const std::string glb = gltf.Glb();
    Result<Document> document = Document::Open(glb, {});
    if (document.ok()) (void)ReadMaterials(&*document);
  }
}

TEST(Materials, EmitLight) {
  HandMadeGltf gltf;
  gltf.AddFloats({0}, "SCALAR");
  gltf.json["images"] = {{{"uri", "a.png"}}};
  gltf.json["textures"] = {{{"source", 0}}};
  gltf.json["materials"] = {
      {{"emissiveFactor", {0.5, 0.25, 1.0}}, {"emissiveTexture", {{"index", 0}}}},
      {{"emissiveFactor", {1.0, 0.25, 0.0}},
       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8.0}}}}}},
      {{"emissiveFactor", {1.0, 0.0, 0.0}},
       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1e9}}}}}},
      {{"extensions", {{"KHR_materials_emissive_strength", 3}}}}};
  const std::string glb = gltf.Glb();
  Result<Document> document = Document::Open(glb, {});
  ASSERT_TRUE(document.ok()) << document.status().ToString();
  const auto materials = ReadMaterials(&*document);
  ASSERT_TRUE(materials.ok()) << materials.status().ToString();
  EXPECT_EQ((*materials)[0].emission, glm::vec3(0.5f, 0.25f, 1.0f));
  EXPECT_EQ((*materials)[0].emission_image, 0);
  EXPECT_EQ((*materials)[1].emission, glm::vec3(8.0f, 2.0f, 0.0f));
  EXPECT_EQ((*materials)[1].emission_image, kNone);
  EXPECT_EQ((*materials)[2].emission, glm::vec3(kMaxEmission, 0.0f, 0.0f));
  EXPECT_EQ((*materials)[3].emission, glm::vec3(0.0f));
  gltf.json["materials"] = {
      {{"emissiveFactor", {1.0, 0.0, 0.0}},
       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1e300}}}}}}};
  const std::string infinite = gltf.Glb();
  document = Document::Open(infinite, {});
  ASSERT_TRUE(document.ok()) << document.status().ToString();
  EXPECT_EQ(ReadMaterials(&*document).status().code(), StatusCode::kNonFinite);
}

TEST(Materials, OfMToonHaveAColourInShade) {
  HandMadeGltf gltf;
  gltf.AddFloats({0}, "SCALAR");
  gltf.json["materials"] = {
      {{"extensions", {{"VRMC_materials_mtoon", {{"shadeColorFactor", {0.5, 0.25, 0.0}}}}}}},
      {{"extensions", {{"VRMC_materials_mtoon", json::object()}}}},
      json::object()};
  std::string glb = gltf.Glb();
  Result<Document> document = Document::Open(glb, {});
  auto materials = ReadMaterials(&*document);
  ASSERT_TRUE(materials.ok()) << materials.status().ToString();
  EXPECT_EQ((*materials)[0].shade_colour, glm::vec3(0.5f, 0.25f, 0.0f));
  EXPECT_EQ((*materials)[1].shade_colour, glm::vec3(0.0f));
  EXPECT_FALSE((*materials)[2].shade_colour.has_value());
  gltf.json["extensions"]["VRM"]["materialProperties"] = {
      {{"vectorProperties", {{"_ShadeColor", {0.5, 1.0, 0.0, 1.0}}}}}};
  gltf.json["materials"] = {json::object(), json::object()};
  glb = gltf.Glb();
  document = Document::Open(glb, {});
  materials = ReadMaterials(&*document);
  ASSERT_TRUE(materials.ok()) << materials.status().ToString();
  EXPECT_LT(glm::distance(*(*materials)[0].shade_colour, glm::vec3(0.21404f, 1.0f, 0.0f)), 1e-4f);
  EXPECT_FALSE((*materials)[1].shade_colour.has_value());
}

}  // namespace
}  // namespace furrow::gltf
