// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/shapes/shape_rules.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "wrinkle/shapes/shape_program.h"

namespace furrow::wrinkle {
namespace {

using ::testing::ElementsAre;
using Limits = ShapeRule::Limits;

const std::vector<std::string> kRuleShapes = {"happy", "blink", "blinkLeft", "aa", "Oh", "angry"};
const std::vector<ShapeRule::Group> kGroups = {ShapeRule::kNoGroup, ShapeRule::kBlinks,
                                               ShapeRule::kBlinks,  ShapeRule::kMouths,
                                               ShapeRule::kMouths,  ShapeRule::kNoGroup};

std::vector<float> Applied(std::vector<ShapeRule> rules, std::vector<float> weights) {
  ShapeRules(rules, kGroups).Apply(weights);
  return weights;
}

TEST(ShapeRules, BlockStopsTheGroupAtAnyWeight) {
  const std::vector<ShapeRule> rules = {{.shape = 0, .limits = {Limits::kBlock}}};
  EXPECT_THAT(Applied(rules, {0.01f, 1.0f, 0.5f, 0.7f, 0, 0}),
              ElementsAre(0.01f, 0.0f, 0.0f, 0.7f, 0, 0));
  EXPECT_THAT(Applied(rules, {0.0f, 1.0f, 0.5f, 0.7f, 0, 0}),
              ElementsAre(0.0f, 1.0f, 0.5f, 0.7f, 0, 0));
}

TEST(ShapeRules, BlendFadesTheGroup) {
  const std::vector<ShapeRule> rules = {
      {.shape = 0, .limits = {Limits::kNothing, Limits::kNothing, Limits::kBlend}}};
  EXPECT_THAT(Applied(rules, {0.25f, 1.0f, 0, 0.8f, 0.4f, 0}),
              ElementsAre(0.25f, 1.0f, 0, 0.6f, 0.3f, 0));
}

// Two that fade by 0.75 each leave nothing, not a negative weight.
TEST(ShapeRules, LimitsAddUpToAll) {
  const std::vector<ShapeRule> rules = {{.shape = 0, .limits = {Limits::kBlend}},
                                        {.shape = 5, .limits = {Limits::kBlend}}};
  EXPECT_THAT(Applied(rules, {0.25f, 1.0f, 0, 0, 0, 0.25f}),
              ElementsAre(0.25f, 0.5f, 0, 0, 0, 0.25f));
  EXPECT_THAT(Applied(rules, {0.75f, 1.0f, 0, 0, 0, 0.75f}),
              ElementsAre(0.75f, 0.0f, 0, 0, 0, 0.75f));
}

TEST(ShapeRules, BinaryShapesAreOnOrOff) {
  const std::vector<ShapeRule> rules = {{.shape = 1, .is_binary = true},
                                        {.shape = 0, .limits = {Limits::kBlend}}};
  EXPECT_THAT(Applied(rules, {0, 0.5f, 0, 0, 0, 0}), ElementsAre(0, 0.0f, 0, 0, 0, 0));
  EXPECT_THAT(Applied(rules, {0, 0.51f, 0, 0, 0, 0}), ElementsAre(0, 1.0f, 0, 0, 0, 0));
  // Limited at all, they are off.
  EXPECT_THAT(Applied(rules, {0.1f, 1.0f, 0, 0, 0, 0}), ElementsAre(0.1f, 0.0f, 0, 0, 0, 0));
}

// A binary shape limits others by what it becomes.
TEST(ShapeRules, BinaryShapesLimitAsOnes) {
  const std::vector<ShapeRule> rules = {
      {.shape = 0, .is_binary = true, .limits = {Limits::kBlend}}};
  EXPECT_THAT(Applied(rules, {0.4f, 1.0f, 0, 0, 0, 0}), ElementsAre(0.0f, 1.0f, 0, 0, 0, 0));
  EXPECT_THAT(Applied(rules, {0.6f, 1.0f, 0, 0, 0, 0}), ElementsAre(1.0f, 0.0f, 0, 0, 0, 0));
}

TEST(ShapeRules, ShapesThatDoNotExistAreIgnored) {
  EXPECT_TRUE(
      ShapeRules(std::vector<ShapeRule>{{.shape = 99, .is_binary = true}}, kGroups).empty());
  std::vector<float> few = {1.0f};
  ShapeRules(std::vector<ShapeRule>{{.shape = 5, .is_binary = true}}, kGroups).Apply(few);
  EXPECT_THAT(few, ElementsAre(1.0f));
}

// A jawOpen with "overrideMouth: block" is a shape of the mouth, too, and would never move.
TEST(ShapeRules, AShapeDoesNotLimitItsOwnGroup) {
  const std::vector<ShapeRule> rules = {
      {.shape = 3, .limits = {Limits::kBlend, Limits::kNothing, Limits::kBlock}}};
  EXPECT_THAT(Applied(rules, {0, 1.0f, 0, 0.25f, 0.6f, 0}),
              ElementsAre(0, 0.75f, 0, 0.25f, 0.6f, 0));
}

// Gazes and contained shapes belong to formulas.
TEST(ShapeRules, OthersDoNothingHere) {
  EXPECT_TRUE(ShapeRules(std::vector<ShapeRule>{{.shape = 0, .gaze = ShapeRule::Gaze()},
                                                {.shape = 1, .contains = 2}},
                         kGroups)
                  .empty());
}

TEST(ShapeRules, ApplyToEveryPoseOfAProgram) {
  ShapeProgram program = ShapeProgram::ByName(kRuleShapes, kRuleShapes);
  program.SetRules({std::vector<ShapeRule>{{.shape = 0, .limits = {Limits::kBlock}}}, kGroups});
  std::vector<float> weights(kRuleShapes.size());
  ASSERT_EQ(program.Run(std::vector<float>{1, 1, 0, 1, 0, 0}, weights), JobStatus::kOk);
  EXPECT_THAT(weights, ElementsAre(1, 0, 0, 1, 0, 0));
}

}  // namespace
}  // namespace furrow::wrinkle
