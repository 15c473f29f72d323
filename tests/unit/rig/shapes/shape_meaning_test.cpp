// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/shape_meaning.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/rig/shapes/shipped_shape_maps.h"

namespace furrow::rig {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using wrinkle::ShapeRule;
using Names = std::vector<std::string>;

ShapeRule::Group GroupOf(const std::string& name, const ShapeMatcher& matcher) {
  return matcher.MeaningsOf(Names{name}).GroupOf(0);
}

TEST(ShapeMeanings, FindShapesByAnyName) {
  const ShapeMatcher matcher = ShippedShapeMatcher();
  const ShapeMeanings meanings = matcher.MeaningsOf(
      Names{"mouthOpen", "jaw_open", "Mouth_Ape_Shape", "scar", "eyeSquintLeft", "cheekPuff"});
  EXPECT_EQ(meanings.Find("jawOpen"), 1) << "mouthOpen is for faces without jawOpen";
  EXPECT_EQ(meanings.Find("mouthClose"), 2) << "another vocabulary's word for it";
  EXPECT_EQ(meanings.Find("browInnerUp"), -1);
  EXPECT_EQ(meanings.Find("scar"), -1);
  EXPECT_EQ(matcher.MeaningsOf(Names{"mouthOpen"}).Find("jawOpen"), 0);
  // SRanipal's Jaw_Open is jawOpen less mouthClose.
  const Names vive = {"Jaw_Open", "Mouth_Ape_Shape", "Mouth_Pout", "Eye_Left_Blink"};
  EXPECT_EQ(matcher.MeaningsOf(vive).Find("jawOpen"), -1);
  EXPECT_EQ(matcher.MeaningsOf(vive).Find("mouthClose"), 1);
}

TEST(ShapeMeanings, GroupPresetsAndWhatMeansTheSame) {
  const ShapeMatcher matcher = ShippedShapeMatcher();
  for (const char* name : {"blink", "Blink_L", "blinkRight", "eyeBlinkLeft", "eyeBlink_R",
                           "eyesClosed", "Fcl_EYE_Close", "Eye_Left_Blink"}) {
    EXPECT_EQ(GroupOf(name, matcher), ShapeRule::kBlinks) << name;
  }
  for (const char* name : {"lookUp", "LookLeft", "eyeLookInLeft", "Eye_L_Look_R", "eyesLookDown"}) {
    EXPECT_EQ(GroupOf(name, matcher), ShapeRule::kLooks) << name;
  }
  for (const char* name : {"aa", "A", "Fcl_MTH_I", "viseme_PP", "jawOpen", "mouthSmile_L",
                           "tongueOut", "mouthClose", "Fcl_MTH_Fun", "A25_Jaw_Open"}) {
    EXPECT_EQ(GroupOf(name, matcher), ShapeRule::kMouths) << name;
  }
  // An emotion limits the mouth; it is not limited with it, although "fun" only smiles.
  for (const char* name : {"happy", "Fun", "relaxed", "Fcl_ALL_Fun", "Sorrow", "surprised",
                           "browInnerUp", "cheekPuff", "eyeSquintLeft", "scar", ""}) {
    EXPECT_EQ(GroupOf(name, matcher), ShapeRule::kNoGroup) << name;
  }
}

TEST(ShapeMeanings, WithoutMapsKnowArkitAndPresets) {
  const ShapeMatcher none;
  EXPECT_EQ(GroupOf("blink", none), ShapeRule::kBlinks);
  EXPECT_EQ(GroupOf("EyeBlinkLeft", none), ShapeRule::kBlinks);
  EXPECT_EQ(GroupOf("jawOpen", none), ShapeRule::kMouths);
  EXPECT_EQ(GroupOf("jaw_open", none), ShapeRule::kNoGroup);
  EXPECT_EQ(none.MeaningsOf(Names{"a", "JawOpen"}).Find("jawOpen"), 1);
}

TEST(ShapeMeanings, LidsFadeBySide) {
  const ShapeMatcher matcher = ShippedShapeMatcher();
  const auto fades = matcher
                         .MeaningsOf(Names{"eyeBlink_L", "eyeBlink_R", "eyeSquint_L",
                                           "eyeLookDown_R", "eyeLookUp_L", "eyeWide_L"})
                         .LidFades();
  ASSERT_EQ(fades.size(), 2u);
  EXPECT_EQ(fades[0].shape, 2u);
  EXPECT_FLOAT_EQ(fades[0].share, 0.8f);
  EXPECT_THAT(fades[0].blinks, ElementsAre(0u));
  EXPECT_EQ(fades[1].shape, 3u);
  EXPECT_FLOAT_EQ(fades[1].share, 1.0f);
  EXPECT_THAT(fades[1].blinks, ElementsAre(1u));
  // A shape for both sides fades by both eyes; one shape may close them.
  const auto both = matcher.MeaningsOf(Names{"blink", "lookDown", "happy"}).LidFades();
  ASSERT_EQ(both.size(), 1u);
  EXPECT_EQ(both[0].shape, 1u);
  EXPECT_THAT(both[0].blinks, ElementsAre(0u, 0u));
  EXPECT_THAT(matcher.MeaningsOf(Names{"eyeSquintLeft", "eyeBlinkRight"}).LidFades(), IsEmpty());
}

}  // namespace
}  // namespace furrow::rig
