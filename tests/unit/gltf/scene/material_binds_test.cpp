// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/material_binds.h"

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gltf/limits.h"
#include "tests/unit/gltf/gltf_testing.h"

namespace furrow::gltf {
namespace {

using Json = nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

struct BindsRead {
  std::vector<MaterialBind> binds;
  std::vector<std::string> warnings;
  Status status;
};

BindsRead BindsOf(const HandMadeGltf& gltf) {
  const std::string glb = gltf.Glb();
  Result<Document> document = Document::Open(glb, {});
  if (!document.ok()) return {{}, {}, document.status()};
  const auto materials = ReadMaterials(&*document);
  if (!materials.ok()) return {{}, {}, materials.status()};
  auto binds = ReadMaterialBinds(&*document, *materials);
  if (!binds.ok()) return {{}, {}, binds.status()};
  return {std::move(*binds), document->warnings(), {}};
}

// Materials "Face" (grey, its texture moved and halved) and "Eye" (white, MToon of VRM 1.0).
HandMadeGltf TwoMaterials() {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["images"] = {{{"uri", "a.png"}}};
  gltf.json["textures"] = {{{"source", 0}}};
  gltf.json["materials"] = {
      {{"name", "Face"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.5, 0.5, 0.5, 0.25}},
         {"baseColorTexture",
          {{"index", 0},
           {"extensions",
            {{"KHR_texture_transform", {{"scale", {0.5, 0.5}}, {"offset", {0.25, 0}}}}}}}}}}},
      {{"name", "Eye"},
       {"emissiveFactor", {0.25, 0, 0}},
       {"extensions", {{"VRMC_materials_mtoon", {{"shadeColorFactor", {0.6, 0.4, 0.2}}}}}}}};
  return gltf;
}

Json& Expressions(HandMadeGltf* gltf) {
  return gltf->json["extensions"]["VRMC_vrm"]["expressions"];
}

// The form in which UniVRM and the VRM add-on for Blender write them.
TEST(MaterialBinds, OfVrm1) {
  HandMadeGltf gltf = TwoMaterials();
  Expressions(&gltf) = {
      {"preset",
       {{"happy",
         {{"isBinary", false},
          {"morphTargetBinds", Json::array()},
          {"materialColorBinds",
           {{{"material", 0}, {"type", "color"}, {"targetValue", {1.0, 0.25, 0.5, 1.0}}},
            {{"material", 1}, {"type", "emissionColor"}, {"targetValue", {0.25, 2.0, 0, 1}}}}}}},
        {"lookLeft",
         {{"textureTransformBinds",
           {{{"material", 1}, {"scale", {1.0, 1.0}}, {"offset", {0.1, -0.2}}}}}}}}},
      {"custom", {{"nothing", {{"overrideBlink", "block"}}}}}};
  const BindsRead read = BindsOf(gltf);
  ASSERT_TRUE(read.status.ok()) << read.status.ToString();
  EXPECT_THAT(read.warnings, IsEmpty());
  ASSERT_THAT(read.binds, SizeIs(3));
  EXPECT_EQ(read.binds[0].shape, "happy");
  EXPECT_EQ(read.binds[0].material, 0);
  EXPECT_EQ(read.binds[0].base_colour, glm::vec4(0.5f, -0.25f, 0.0f, 0.75f));
  EXPECT_EQ(read.binds[1].material, 1);
  EXPECT_EQ(read.binds[1].emission, glm::vec3(0.0f, 2.0f, 0.0f));
  EXPECT_EQ(read.binds[2].shape, "lookLeft");
  EXPECT_EQ(read.binds[2].uv_scale, glm::vec2(0.0f));
  EXPECT_EQ(read.binds[2].uv_offset, glm::vec2(0.1f, -0.2f));
}

// The target replaces the transform that the material has at rest, uv / 2 + (0.25, 0), and its UVs
// are already in the mesh: 2 uv + (0.75, 0.5) is 4 uv' + (-0.25, 0.5).
TEST(MaterialBinds, ReplaceTheTransformAtRest) {
  HandMadeGltf gltf = TwoMaterials();
  Expressions(&gltf)["preset"]["sad"]["textureTransformBinds"] = {
      {{"material", 0}, {"scale", {2.0, 0.5}}, {"offset", {0.75, 0.5}}}};
  const BindsRead read = BindsOf(gltf);
  ASSERT_THAT(read.binds, SizeIs(1)) << read.status.ToString();
  EXPECT_EQ(read.binds[0].uv_scale, glm::vec2(3.0f, 0.0f));
  EXPECT_EQ(read.binds[0].uv_offset, glm::vec2(-0.25f, 0.5f));
}

// VRM 0.x names materials, states Unity's colours, which are sRGB, and lets v point up.
TEST(MaterialBinds, OfVrm0) {
  HandMadeGltf gltf = TwoMaterials();
  gltf.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"].erase("extensions");
  const auto value = [](const char* material, const char* property, Json target) {
    return Json{
        {"materialName", material}, {"propertyName", property}, {"targetValue", std::move(target)}};
  };
  gltf.json["extensions"]["VRM"]["blendShapeMaster"]["blendShapeGroups"] = {
      {{"name", "Blush"},
       {"presetName", "unknown"},
       {"binds", Json::array()},
       {"materialValues",
        {value("Face", "_Color", {1.0, 0.5, 0.5, 1.0}),
         value("Eye", "_EmissionColor", {0.5, 0.5, 0.5, 1.0})}}},
      {{"name", "LookUp"},
       {"presetName", "lookup"},
       {"materialValues",
        {value("Face", "_MainTex_ST", {1.0, 0.5, 0.25, 0.25}),
         value("Face", "_BumpMap_ST", {1.0, 0.5, 0.25, 0.25}),
         value("Eye", "_MainTex_ST_S", {1.0, 7.0, 0.125, 7.0})}}},
      {{"name", "LookDown"},
       {"presetName", "lookdown"},
       {"materialValues", {value("Eye", "_MainTex_ST_T", {7.0, 1.0, 7.0, 0.125})}}}};
  const BindsRead read = BindsOf(gltf);
  ASSERT_TRUE(read.status.ok()) << read.status.ToString();
  EXPECT_THAT(read.warnings, IsEmpty()) << "_BumpMap_ST says what _MainTex_ST does";
  ASSERT_THAT(read.binds, SizeIs(5));
  EXPECT_EQ(read.binds[0].shape, "Blush");
  EXPECT_NEAR(read.binds[0].base_colour.r, 0.5f, 1e-6f);
  EXPECT_NEAR(read.binds[0].base_colour.g, 0.21404f - 0.5f, 1e-4f);
  EXPECT_NEAR(read.binds[0].base_colour.a, 0.75f, 1e-6f);
  EXPECT_EQ(read.binds[1].emission, glm::vec3(0.25f, 0.5f, 0.5f)) << "the emission is linear";
  EXPECT_EQ(read.binds[2].shape, "lookup");
  EXPECT_EQ(read.binds[2].uv_scale, glm::vec2(0.0f, -0.5f));
  EXPECT_EQ(read.binds[2].uv_offset, glm::vec2(0.25f, 0.25f));
  EXPECT_EQ(read.binds[3].uv_offset, glm::vec2(0.125f, 0.0f));
  EXPECT_EQ(read.binds[4].uv_offset, glm::vec2(0.0f, -0.125f));
}

// Half of a ball is in shade.
TEST(MaterialBinds, TheShadesColourAloneMovesTheBaseColourByHalf) {
  HandMadeGltf gltf = TwoMaterials();
  Expressions(&gltf)["custom"]["pale"]["materialColorBinds"] = {
      {{"material", 1}, {"type", "shadeColor"}, {"targetValue", {0.2, 0.4, 0.4, 1}}}};
  Expressions(&gltf)["custom"]["paler"]["materialColorBinds"] = {
      {{"material", 1}, {"type", "shadeColor"}, {"targetValue", {0.2, 0.4, 0.4, 1}}},
      {{"material", 1}, {"type", "color"}, {"targetValue", {0.5, 1, 1, 1}}}};
  const BindsRead read = BindsOf(gltf);
  ASSERT_THAT(read.binds, SizeIs(2)) << read.status.ToString();
  EXPECT_LT(glm::distance(read.binds[0].base_colour, glm::vec4(-0.2f, 0.0f, 0.1f, 0.0f)), 1e-6f);
  EXPECT_EQ(read.binds[1].base_colour, glm::vec4(-0.5f, 0.0f, 0.0f, 0.0f));
}

TEST(MaterialBinds, OfAPackage) {
  HandMadeGltf gltf = TwoMaterials();
  gltf.json["scenes"] = {{{"nodes", {0}}}};
  gltf.json["scenes"][0]["extras"][kMaterialBindsExtra] = {
      {{"shape", "blush"}, {"material", 0}, {"baseColor", {0.1, -0.5, -0.5, 0.5}}},
      {{"shape", "blush"},
       {"material", 1},
       {"emission", {0, 2, 0}},
       {"uvScale", {1, 0}},
       {"uvOffset", {0, -0.5}}},
      {{"shape", "rest"}, {"material", 1}},
      {{"material", 1}, {"emission", {0, 2, 0}}},
      {{"shape", "blush"}, {"material", 7}, {"emission", {0, 2, 0}}}};
  const BindsRead read = BindsOf(gltf);
  ASSERT_THAT(read.binds, SizeIs(2)) << read.status.ToString();
  EXPECT_EQ(read.binds[0].base_colour, glm::vec4(0.1f, -0.5f, -0.5f, 0.5f));
  EXPECT_EQ(read.binds[1].emission, glm::vec3(0, 2, 0));
  EXPECT_EQ(read.binds[1].uv_scale, glm::vec2(1, 0));
  EXPECT_EQ(read.binds[1].uv_offset, glm::vec2(0, -0.5f));
  EXPECT_THAT(read.warnings, ElementsAre(HasSubstr("1 ignored bind of expressions to materials"),
                                         HasSubstr("1 ignored bind of expressions of materials")));
}

TEST(MaterialBinds, PropertiesThatAreNotDrawnAreNamedOnce) {
  HandMadeGltf gltf = TwoMaterials();
  Json binds;
  for (const char* type : {"rimColor", "outlineColor", "rimColor", "matcapColor", "heat"}) {
    binds.push_back({{"material", 0}, {"type", type}, {"targetValue", {1, 1, 1, 1}}});
  }
  Expressions(&gltf)["preset"]["happy"]["materialColorBinds"] = binds;
  Expressions(&gltf)["preset"]["angry"]["materialColorBinds"] = binds;
  const BindsRead read = BindsOf(gltf);
  EXPECT_THAT(read.binds, IsEmpty());
  EXPECT_THAT(read.warnings,
              ElementsAre(HasSubstr("properties of materials that are not drawn: 'heat', "
                                    "'matcapColor', 'outlineColor', 'rimColor'")));
  HandMadeGltf old = TwoMaterials();
  old.json["extensions"]["VRM"]["blendShapeMaster"]["blendShapeGroups"] = {
      {{"name", "Blush"},
       {"materialValues",
        {{{"materialName", "Face"},
          {"propertyName", "_BumpMap_ST"},
          {"targetValue", {1, 1, 0, 0}}}}}}};
  EXPECT_THAT(BindsOf(old).warnings, ElementsAre(HasSubstr("not drawn: '_BumpMap_ST'")));
}

// Anything may stand where VRM expects lists and numbers.
TEST(MaterialBinds, BrokenOnesAreIgnored) {
  const double huge = 1e300;
  for (const Json& bind :
       {Json(1), Json("x"), Json{{"material", 2}, {"type", "color"}},
        Json{{"material", -1}, {"type", "color"}, {"targetValue", {1, 1, 1, 1}}},
        Json{{"material", huge}, {"type", "color"}, {"targetValue", {1, 1, 1, 1}}},
        Json{{"material", 0}, {"type", "color"}, {"targetValue", {1, 1}}},
        Json{{"material", 0}, {"type", "color"}, {"targetValue", {1, "x", 1, 1}}},
        Json{{"material", 0}, {"type", "color"}, {"targetValue", {1, huge, 1, 1}}},
        Json{{"material", 0},
             {"type", "color"},
             {"targetValue", {std::numeric_limits<double>::quiet_NaN(), 1, 1}}},
        Json{{"material", 0}, {"type", 3}, {"targetValue", {1, 1, 1, 1}}}}) {
    HandMadeGltf gltf = TwoMaterials();
    Expressions(&gltf)["preset"]["happy"]["materialColorBinds"] = Json::array({bind});
    const BindsRead read = BindsOf(gltf);
    EXPECT_TRUE(read.status.ok()) << bind << read.status.ToString();
    EXPECT_THAT(read.binds, IsEmpty()) << bind;
    EXPECT_THAT(read.warnings, SizeIs(1)) << bind;
  }
  for (const Json& bind :
       {Json{{"material", 0}, {"scale", {huge, 1}}}, Json{{"material", 0}, {"offset", {0, "x"}}},
        Json{{"material", 0}, {"offset", {2e4, 0}}}}) {
    HandMadeGltf gltf = TwoMaterials();
    Expressions(&gltf)["preset"]["happy"]["textureTransformBinds"] = Json::array({bind});
    const BindsRead read = BindsOf(gltf);
    EXPECT_THAT(read.binds, IsEmpty()) << bind;
    EXPECT_THAT(read.warnings, ElementsAre(HasSubstr("values that cannot be drawn"))) << bind;
  }
}

// Textures without extent have no UVs at rest to scale, and turned ones no axes.
TEST(MaterialBinds, TransformsThatUvsAtRestCannotExpressAreIgnored) {
  for (const Json& transform : {Json{{"scale", {0.0, 1.0}}}, Json{{"rotation", 1.0}}}) {
    HandMadeGltf gltf = TwoMaterials();
    gltf.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
        {"KHR_texture_transform", transform}};
    Expressions(&gltf)["preset"]["happy"]["textureTransformBinds"] = {
        {{"material", 0}, {"scale", {2.0, 1.0}}}};
    const BindsRead read = BindsOf(gltf);
    EXPECT_THAT(read.binds, IsEmpty()) << transform;
    EXPECT_THAT(read.warnings, ElementsAre(HasSubstr("cannot be drawn"))) << transform;
  }
}

TEST(MaterialBinds, SumsStayInTheirRanges) {
  HandMadeGltf gltf = TwoMaterials();
  Json binds;
  for (int i = 0; i < 8; ++i) {
    binds.push_back({{"material", 0}, {"type", "color"}, {"targetValue", {1, 0, 1, 1}}});
  }
  Expressions(&gltf)["preset"]["happy"]["materialColorBinds"] = binds;
  const BindsRead read = BindsOf(gltf);
  ASSERT_THAT(read.binds, SizeIs(1));
  EXPECT_EQ(read.binds[0].base_colour, glm::vec4(1.0f, -1.0f, 1.0f, 1.0f));
}

TEST(MaterialBinds, TooManyAreAnError) {
  HandMadeGltf gltf = TwoMaterials();
  Json& binds = Expressions(&gltf)["preset"]["happy"]["materialColorBinds"];
  for (std::size_t i = 0; i <= kMaxVrmBinds; ++i) binds.push_back(0);
  EXPECT_EQ(BindsOf(gltf).status.code(), StatusCode::kLimit);
  // Binds of VRM 0.x count once per material of the name.
  HandMadeGltf old = TwoMaterials();
  for (int i = 0; i < 1000; ++i) old.json["materials"].push_back({{"name", "Face"}});
  Json& values =
      old.json["extensions"]["VRM"]["blendShapeMaster"]["blendShapeGroups"][0]["materialValues"];
  for (int i = 0; i < 100; ++i) {
    values.push_back(
        {{"materialName", "Face"}, {"propertyName", "_Color"}, {"targetValue", {1, 1, 1, 1}}});
  }
  old.json["extensions"]["VRM"]["blendShapeMaster"]["blendShapeGroups"][0]["name"] = "x";
  EXPECT_EQ(BindsOf(old).status.code(), StatusCode::kLimit);
}

}  // namespace
}  // namespace furrow::gltf
