// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/save/macro_factors.h"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

MacroFactors OfAge(float age) {
  MacroValues values;
  values.age = age;
  return FactorsOf(values);
}

// Independent values: MakeHuman's anchors are 1 year at 0, 10 at 0.1875, 25 at 0.5 and 90 at 1, and
// its formulas round 1 / 0.1875 to 5.333.
TEST(FactorsOf, AgesFollowMakeHumansFormulas) {
  for (const float a : {0.0f, 0.05f, 0.1f, 0.1875f, 0.25f, 0.4f, 0.499f, 0.5f, 0.75f, 1.0f}) {
    float baby = 0.0f, child = 0.0f, young = 0.0f, old = 0.0f;
    if (a < 0.5f) {
      baby = std::max(0.0f, 1.0f - 5.333f * a);
      young = std::max(0.0f, 3.2f * (a - 0.1875f));
      child = std::max(0.0f, std::min(1.0f, 5.333f * a) - young);
    } else {
      old = 2.0f * a - 1.0f;
      young = 1.0f - old;
    }
    const MacroFactors factors = OfAge(a);
    EXPECT_NEAR(factors.Of("baby"), baby, 1e-3f) << a;
    EXPECT_NEAR(factors.Of("child"), child, 1e-3f) << a;
    EXPECT_NEAR(factors.Of("young"), young, 1e-3f) << a;
    EXPECT_NEAR(factors.Of("old"), old, 1e-3f) << a;
  }
}

TEST(FactorsOf, SharesOfEveryVariableSumToOne) {
  for (const float v : {0.0f, 0.1f, 0.3f, 0.5f, 0.8f, 1.0f}) {
    MacroValues values;
    for (float MacroValues::*value :
         {&MacroValues::gender, &MacroValues::age, &MacroValues::muscle, &MacroValues::weight,
          &MacroValues::height, &MacroValues::breast_size, &MacroValues::breast_firmness,
          &MacroValues::proportions, &MacroValues::caucasian, &MacroValues::asian})
      values.*value = v;
    std::array<float, kNumMacroVariables> sum{};
    const MacroFactors factors = FactorsOf(values);
    for (std::size_t i = 0; i < kMacroWords.size(); ++i) {
      EXPECT_GE(factors.share[i], 0.0f) << kMacroWords[i].word << " at " << v;
      sum[static_cast<std::size_t>(kMacroWords[i].variable)] += factors.share[i];
    }
    for (const float s : sum) EXPECT_NEAR(s, 1.0f, 1e-5f) << v;
  }
}

TEST(FactorsOf, ThreeWordsShareAValue) {
  MacroValues values;
  values.weight = 0.8f;
  values.muscle = 0.1f;
  values.gender = 0.25f;
  const MacroFactors factors = FactorsOf(values);
  EXPECT_FLOAT_EQ(factors.Of("maxweight"), 0.6f);
  EXPECT_FLOAT_EQ(factors.Of("averageweight"), 0.4f);
  EXPECT_FLOAT_EQ(factors.Of("minweight"), 0.0f);
  EXPECT_FLOAT_EQ(factors.Of("minmuscle"), 0.8f);
  EXPECT_FLOAT_EQ(factors.Of("male"), 0.25f);
  EXPECT_FLOAT_EQ(factors.Of("female"), 0.75f);
  EXPECT_FLOAT_EQ(factors.Of("averagecup"), 1.0f);
}

TEST(FactorsOf, RacesAreNormalised) {
  MacroValues values;
  values.caucasian = 0.2f;
  values.asian = 0.6f;
  values.african = 0.0f;
  EXPECT_FLOAT_EQ(FactorsOf(values).Of("asian"), 0.75f);
  values.caucasian = values.asian = 0.0f;
  EXPECT_FLOAT_EQ(FactorsOf(values).Of("african"), 1.0f / 3.0f);
}

TEST(MacroValuesOf, TakesTheModifiersOfASave) {
  MhmSave save;
  save.modifiers = {{"macrodetails/Gender", 1.0f},
                    {"macrodetails-universal/Weight", -0.5f},
                    {"nose/nose-hump-decr|incr", 1.0f},
                    {"breast/BreastSize", 0.75f}};
  const MacroValues values = MacroValuesOf(save);
  EXPECT_EQ(values.gender, 1.0f);
  EXPECT_EQ(values.weight, 0.0f);
  EXPECT_EQ(values.breast_size, 0.75f);
  EXPECT_EQ(values.age, 0.5f);
  EXPECT_TRUE(IsMacroModifier("macrodetails-height/Height"));
  EXPECT_FALSE(IsMacroModifier("nose/nose-hump-decr|incr"));
}

}  // namespace
}  // namespace furrow::authoring
