// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/expression_list.h"

#include <string>

#include <gtest/gtest.h>

#include "gltf/limits.h"
#include "tests/unit/gltf/gltf_testing.h"

namespace furrow::gltf {
namespace {

using Json = nlohmann::json;

// "name" or "name*" for presets, separated by blanks.
std::string NamesOf(const HandMadeGltf& gltf) {
  const std::string glb = gltf.Glb();
  const Result<Document> document = Document::Open(glb, {});
  EXPECT_TRUE(document.ok()) << document.status().ToString();
  std::string names;
  if (!document.ok()) return names;
  for (const ExpressionObject& expression : ListExpressions(*document)) {
    names += (names.empty() ? "" : " ") + expression.name + (expression.is_preset ? "*" : "");
  }
  return names;
}

TEST(ExpressionList, HasThePresetsOfVrm1First) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["extensions"]["VRMC_vrm"]["expressions"] = {
      {"custom", {{"blush", {{"isBinary", true}}}}},
      {"preset", {{"aa", {{"isBinary", false}}}, {"sad", 3}}}};
  EXPECT_EQ(NamesOf(gltf), "aa* sad* blush");
}

TEST(ExpressionList, TakesTheAuthorsNamesForUnknownPresetsOfVrm0) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["extensions"]["VRM"]["blendShapeMaster"]["blendShapeGroups"] = {
      {{"name", "Joy"}, {"presetName", "joy"}},
      {{"name", "Blush"}, {"presetName", "unknown"}},
      {{"name", std::string(2 * kMaxNameBytes, 'x')}},
      "no object"};
  EXPECT_EQ(NamesOf(gltf), "joy* Blush " + std::string(kMaxNameBytes, 'x') + " ");
}

TEST(ExpressionList, IsEmptyWithoutVrm) {
  EXPECT_EQ(NamesOf(TwoJoints()), "");
  HandMadeGltf gltf = TwoJoints();
  gltf.json["extensions"]["VRMC_vrm"]["expressions"] = Json::array({1});
  EXPECT_EQ(NamesOf(gltf), "");
}

}  // namespace
}  // namespace furrow::gltf
