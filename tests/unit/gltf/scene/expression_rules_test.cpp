// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/expression_rules.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/gltf/gltf_testing.h"

namespace furrow::gltf {
namespace {

using Json = nlohmann::json;
using Override = ExpressionRule::Override;

std::vector<ExpressionRule> RulesOf(const HandMadeGltf& gltf,
                                    std::vector<std::string>* warnings = nullptr) {
  const std::string glb = gltf.Glb();
  Result<Document> document = Document::Open(glb, {});
  EXPECT_TRUE(document.ok()) << document.status().ToString();
  if (!document.ok()) return {};
  auto rules = ReadExpressionRules(&*document);
  if (warnings != nullptr) *warnings = document->warnings();
  return rules;
}

TEST(ExpressionRules, OfVrm1) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["extensions"]["VRMC_vrm"]["expressions"] = {
      {"preset",
       {{"happy", {{"overrideBlink", "block"}, {"overrideMouth", "blend"}}},
        {"sad", {{"overrideBlink", "none"}}}}},
      {"custom", {{"heart eyes", {{"isBinary", true}}}}}};
  const auto rules = RulesOf(gltf);
  ASSERT_EQ(rules.size(), 2u) << "sad does nothing";
  EXPECT_EQ(rules[0].shape, "happy");
  EXPECT_FALSE(rules[0].is_binary);
  EXPECT_EQ(rules[0].overrides,
            (std::array<Override, 3>{Override::kBlock, Override::kNothing, Override::kBlend}));
  EXPECT_EQ(rules[1].shape, "heart eyes");
  EXPECT_TRUE(rules[1].is_binary);
}

TEST(ExpressionRules, OfVrm0) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["extensions"]["VRM"]["blendShapeMaster"]["blendShapeGroups"] = {
      {{"name", "Joy"}, {"presetName", "joy"}, {"isBinary", true}},
      {{"name", "Hearts"}, {"presetName", "unknown"}, {"isBinary", true}},
      {{"name", "Sorrow"}, {"presetName", "sorrow"}, {"isBinary", false}}};
  const auto rules = RulesOf(gltf);
  ASSERT_EQ(rules.size(), 2u);
  EXPECT_EQ(rules[0].shape, "joy");
  EXPECT_EQ(rules[1].shape, "Hearts");
}

TEST(ExpressionRules, OfAPackage) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["scenes"] = {{{"nodes", {0}}}};
  gltf.json["scenes"][0]["extras"][kRulesExtra] = {
      {{"shape", "happy"}, {"overrideLookAt", "blend"}}, {{"shape", ""}, {"isBinary", true}}};
  const auto rules = RulesOf(gltf);
  ASSERT_EQ(rules.size(), 1u);
  EXPECT_EQ(rules[0].overrides[1], Override::kBlend);
}

// Looks follow the gaze by the ranges, if the avatar looks by expressions.
TEST(ExpressionRules, OfLooks) {
  HandMadeGltf gltf = TwoJoints();
  const Json plain = {{"isBinary", false}};
  Json& vrm = gltf.json["extensions"]["VRMC_vrm"];
  vrm["expressions"]["preset"] = {{"lookUp", plain}, {"lookLeft", plain}, {"aa", plain}};
  vrm["expressions"]["custom"] = {{"lookDown", plain}};
  vrm["lookAt"] = {{"type", "expression"},
                   {"rangeMapVerticalUp", {{"inputMaxValue", 45}, {"outputScale", 0.5}}},
                   {"rangeMapHorizontalOuter", {{"inputMaxValue", 60}, {"outputScale", 4}}},
                   {"rangeMapHorizontalInner", {{"inputMaxValue", 1}, {"outputScale", 0}}}};
  const auto rules = RulesOf(gltf);
  ASSERT_EQ(rules.size(), 2u) << "presets for looking only";
  EXPECT_EQ(rules[0].shape, "lookLeft");
  EXPECT_EQ(rules[0].gaze->input, 60.0f);
  EXPECT_EQ(rules[0].gaze->output, 1.0f) << "a weight";
  EXPECT_EQ(rules[1].gaze->input, 45.0f);
  EXPECT_EQ(rules[1].gaze->output, 0.5f);
  vrm["lookAt"]["type"] = "bone";
  EXPECT_TRUE(RulesOf(gltf).empty());
  HandMadeGltf old = TwoJoints();
  old.json["extensions"]["VRM"] = {
      {"blendShapeMaster", {{"blendShapeGroups", {{{"name", "Up"}, {"presetName", "lookup"}}}}}},
      {"firstPerson", {{"lookAtTypeName", "BlendShape"}, {"lookAtVerticalUp", {{"xRange", 80}}}}}};
  ASSERT_EQ(RulesOf(old).size(), 1u);
  EXPECT_EQ(RulesOf(old)[0].gaze->input, 80.0f);
  EXPECT_EQ(RulesOf(old)[0].gaze->output, 1.0f) << "the default";
}

TEST(ExpressionRules, OfAPackageHaveMembersOfTheirOwn) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["scenes"] = {{{"nodes", {0}}}};
  gltf.json["scenes"][0]["extras"][kRulesExtra] = {
      {{"shape", "mouthClose"}, {"contains", "jawOpen"}},
      {{"shape", "lookUp"}, {"gaze", {{"inputMaxValue", 45}, {"outputScale", 0.5}}}},
      {{"shape", "odd"}, {"gaze", 7}, {"contains", 7}}};
  const auto rules = RulesOf(gltf);
  ASSERT_EQ(rules.size(), 2u);
  EXPECT_EQ(rules[0].contains, "jawOpen");
  EXPECT_EQ(rules[1].gaze->input, 45.0f);
  EXPECT_EQ(rules[1].gaze->output, 0.5f);
}

TEST(ExpressionRules, UnexpectedTypesCountAsMissing) {
  for (const Json& odd : {Json(5), Json("block"), Json::array({1, "x"}), Json::object()}) {
    HandMadeGltf gltf = TwoJoints();
    gltf.json["extensions"]["VRMC_vrm"]["expressions"] = {
        {"preset", odd},
        {"custom", {{"a", odd}, {"b", {{"overrideBlink", odd}, {"isBinary", odd}}}}}};
    const auto rules = RulesOf(gltf);
    EXPECT_EQ(rules.size(), odd == Json("block") ? 1u : 0u) << odd;
    HandMadeGltf package = TwoJoints();
    package.json["scenes"] = {{{"nodes", {0}}}};
    package.json["scenes"][0]["extras"][kRulesExtra] = odd;
    EXPECT_TRUE(RulesOf(package).empty());
  }
}

TEST(ExpressionRules, AreLimited) {
  HandMadeGltf gltf = TwoJoints();
  Json& groups = gltf.json["extensions"]["VRM"]["blendShapeMaster"]["blendShapeGroups"];
  for (int i = 0; i < 2050; ++i) {
    groups.push_back({{"name", "g" + std::to_string(i)}, {"isBinary", true}});
  }
  std::vector<std::string> warnings;
  EXPECT_EQ(RulesOf(gltf, &warnings).size(), 2048u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("2 ignored rules"), std::string::npos) << warnings[0];
}

}  // namespace
}  // namespace furrow::gltf
