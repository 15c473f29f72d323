// SPDX-License-Identifier: Apache-2.0
#include "character/gltf/gltf_shape_rules.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/files.h"
#include "character/gltf/gltf_writer.h"
#include "character/package/package.h"

namespace furrow::character {
namespace {

using wrinkle::ShapeRule;
using Override = gltf::ExpressionRule::Override;

TEST(GltfShapeRules, BelongToTheShapesThatExist) {
  const std::vector<gltf::ExpressionRule> from = {
      {.shape = "Smile", .is_binary = true},
      {.shape = "smile", .overrides = {Override::kBlock}},  // a second rule of the shape
      {.shape = "nobody", .is_binary = true},
      {.shape = "jawOpen", .overrides = {Override::kNothing, Override::kBlock, Override::kBlend}}};
  const std::vector<std::string> shapes = {"jawOpen", "smile"};
  const auto rules = MakeShapeRules(from, shapes);
  ASSERT_EQ(rules.size(), 2u);
  EXPECT_EQ(rules[0].shape, 1u);
  EXPECT_TRUE(rules[0].is_binary);
  EXPECT_EQ(rules[1].shape, 0u);
  EXPECT_EQ(rules[1].limits[ShapeRule::kBlinks], ShapeRule::Limits::kNothing);
  EXPECT_EQ(rules[1].limits[ShapeRule::kLooks], ShapeRule::Limits::kBlock);
  EXPECT_EQ(rules[1].limits[ShapeRule::kMouths], ShapeRule::Limits::kBlend);
}

TEST(GltfShapeRules, NameOtherShapes) {
  const std::vector<gltf::ExpressionRule> from = {
      {.shape = "mouthClose", .contains = "JawOpen"},
      {.shape = "lookUp", .gaze = gltf::VrmLookAt::Range{45.0f, 0.5f}, .contains = "nobody"}};
  const auto rules =
      MakeShapeRules(from, std::vector<std::string>{"lookUp", "mouthClose", "jawOpen"});
  ASSERT_EQ(rules.size(), 2u);
  EXPECT_EQ(rules[0].contains, 2u);
  EXPECT_FALSE(rules[0].gaze.has_value());
  EXPECT_EQ(rules[1].contains, ShapeRule::kNoShape);
  EXPECT_EQ(rules[1].gaze->input, 45.0f);
  EXPECT_EQ(rules[1].gaze->output, 0.5f);
}

TEST(GltfShapeRules, ComeBackFromAPackage) {
  const auto toy =
      ReadFile(FURROW_SOURCE_DIR "/tests/unit/character/gltf/fixtures/toy.glb", 1 << 20);
  ASSERT_TRUE(toy.ok());
  auto character = ParseCharacter(*toy, {});
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  EXPECT_TRUE(character->shape_rules.empty());
  character->shape_rules = {{.shape = 1,
                             .is_binary = true,
                             .limits = {ShapeRule::Limits::kBlend, ShapeRule::Limits::kNothing,
                                        ShapeRule::Limits::kBlock},
                             .gaze = ShapeRule::Gaze{.input = 50.0f, .output = 0.25f},
                             .contains = 0}};
  const auto glb = CharacterGlb(*character);
  ASSERT_TRUE(glb.ok()) << glb.status().ToString();
  const auto back = ParseCharacter(*glb, {});
  ASSERT_TRUE(back.ok()) << back.status().ToString();
  ASSERT_EQ(back->shape_rules.size(), 1u);
  EXPECT_EQ(back->shape_rules[0].shape, 1u);
  EXPECT_TRUE(back->shape_rules[0].is_binary);
  EXPECT_EQ(back->shape_rules[0].limits, character->shape_rules[0].limits);
  EXPECT_EQ(back->shape_rules[0].gaze->input, 50.0f);
  EXPECT_EQ(back->shape_rules[0].gaze->output, 0.25f);
  EXPECT_EQ(back->shape_rules[0].contains, 0u);
}

}  // namespace
}  // namespace furrow::character
