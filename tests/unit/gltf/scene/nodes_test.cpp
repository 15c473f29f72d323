// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/nodes.h"

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

Result<NodeForest> Read(const json& nodes, std::vector<std::string>* warnings = nullptr) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["nodes"] = nodes;
  const std::string bytes = gltf.Glb();
  Result<Document> document = Document::Open(bytes, {});
  FURROW_RETURN_IF_ERROR(document);
  Result<NodeForest> forest = ReadNodes(&*document);
  if (warnings != nullptr) *warnings = document->warnings();
  return forest;
}

TEST(ReadNodes, ComputesModelMatrices) {
  const Result<NodeForest> forest =
      Read(json::array({{{"translation", {0, 0, 1}}},
                        {{"translation", {1, 0, 0}}, {"children", {2}}},
                        {{"scale", {2, 2, 2}}, {"children", {0}}}}));
  ASSERT_TRUE(forest.ok()) << forest.status().ToString();
  EXPECT_THAT(forest->order, ElementsAre(1, 2, 0));
  EXPECT_EQ(glm::vec3(ModelMatrices(*forest)[0][3]), glm::vec3(1, 0, 2));
}

TEST(ReadNodes, KeepsUnitRotationsBitForBit) {
  const Result<NodeForest> forest =
      Read(json::array({{{"rotation", {0.8f, 0, 0, 0.6f}}}, {{"rotation", {0, 0, 0, 2}}}}));
  ASSERT_TRUE(forest.ok());
  EXPECT_EQ(forest->nodes[0].local.rotation, glm::quat(0.6f, 0.8f, 0, 0));
  EXPECT_EQ(forest->nodes[1].local.rotation, glm::quat(1, 0, 0, 0));
}

TEST(ReadNodes, WarnsOncePerKindOfDeviation) {
  const json shear = {{"matrix", {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
  const json flat = {{"matrix", {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
  std::vector<std::string> warnings;
  ASSERT_TRUE(Read(json::array({json::object(), shear, flat, shear, shear}), &warnings).ok());
  EXPECT_THAT(
      warnings,
      ElementsAre(HasSubstr("nodes[1].matrix: the matrix has shear, which is dropped (and 2"),
                  HasSubstr("nodes[2].matrix: the matrix is flat")));
}

TEST(ReadNodes, NamesTheFieldOfAnError) {
  struct Case {
    json nodes;
    StatusCode code;
    const char* where;
  };
  const Case kCases[] = {
      {json::array({{{"children", {0}}}}), StatusCode::kCyclic, "nodes[0].children"},
      {json::array({{{"children", {1}}}, {{"children", {0}}}}), StatusCode::kCyclic,
       "nodes[0].children"},
      {json::array({{{"children", {1, 1}}}, json::object()}), StatusCode::kCyclic,
       "nodes[0].children"},
      {json::array({{{"children", {5}}}}), StatusCode::kSchema, "nodes[0].children"},
      {json::array({{{"mesh", 0}}}), StatusCode::kSchema, "nodes[0].mesh"},
      {json::array({{{"skin", 0}}}), StatusCode::kSchema, "nodes[0].skin"},
      {json::array({{{"translation", {0, 0}}}}), StatusCode::kSchema, "nodes[0].translation"},
      {json::array({{{"matrix", {0, 0}}}}), StatusCode::kSchema, "nodes[0].matrix"},
      {json::array({{{"rotation", {0, 0, 0, 0}}}}), StatusCode::kSchema, "nodes[0].rotation"},
      {json::array({{{"scale", {1e200, 0, 0}}}}), StatusCode::kNonFinite, "nodes[0].scale"},
  };
  for (const Case& test : kCases) {
    const Status status = Read(test.nodes).status();
    EXPECT_EQ(status.code(), test.code) << test.nodes;
    EXPECT_EQ(status.where(), test.where) << test.nodes;
  }
  EXPECT_EQ(Read(json(kMaxNodes + 1, json::object())).status().code(), StatusCode::kLimit);
}

}  // namespace
}  // namespace furrow::gltf
