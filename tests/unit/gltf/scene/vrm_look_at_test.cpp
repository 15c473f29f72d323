// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/vrm_look_at.h"

#include <optional>

#include <gtest/gtest.h>

#include "tests/unit/gltf/gltf_testing.h"

namespace furrow::gltf {
namespace {

std::optional<VrmLookAt> LookAtOf(const HandMadeGltf& gltf) {
  const std::string glb = gltf.Glb();
  Result<Document> document = Document::Open(glb, {});
  EXPECT_TRUE(document.ok()) << document.status().ToString();
  return document.ok() ? ReadVrmLookAt(*document) : std::nullopt;
}

TEST(VrmLookAt, OfVrm1) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["extensions"]["VRMC_vrm"]["lookAt"] = {
      {"type", "bone"},
      {"rangeMapHorizontalInner", {{"inputMaxValue", 60}, {"outputScale", 12.5}}},
      {"rangeMapVerticalUp", {{"inputMaxValue", -3}, {"outputScale", "x"}}}};
  const auto look_at = LookAtOf(gltf);
  ASSERT_TRUE(look_at.has_value());
  EXPECT_EQ(look_at->inner.input, 60.0f);
  EXPECT_EQ(look_at->inner.output, 12.5f);
  EXPECT_EQ(look_at->outer.output, 10.0f) << "the default";
  EXPECT_EQ(look_at->up.input, 90.0f) << "not a range";
  EXPECT_EQ(look_at->up.output, 10.0f);
  gltf.json["extensions"]["VRMC_vrm"]["lookAt"]["type"] = "expression";
  EXPECT_FALSE(LookAtOf(gltf).has_value());
}

TEST(VrmLookAt, OfVrm0) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["extensions"]["VRM"]["firstPerson"] = {
      {"lookAtTypeName", "Bone"},
      {"lookAtHorizontalOuter", {{"curve", {0, 0, 0, 1}}, {"xRange", 90}, {"yRange", 8}}}};
  const auto look_at = LookAtOf(gltf);
  ASSERT_TRUE(look_at.has_value());
  EXPECT_EQ(look_at->outer.output, 8.0f);
  gltf.json["extensions"]["VRM"]["firstPerson"]["lookAtTypeName"] = "BlendShape";
  EXPECT_FALSE(LookAtOf(gltf).has_value());
}

TEST(VrmLookAt, OfOtherFiles) {
  HandMadeGltf gltf = TwoJoints();
  EXPECT_FALSE(LookAtOf(gltf).has_value());
  gltf.json["extensions"]["VRMC_vrm"]["lookAt"] = 7;
  EXPECT_FALSE(LookAtOf(gltf).has_value());
}

}  // namespace
}  // namespace furrow::gltf
