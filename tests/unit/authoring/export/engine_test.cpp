// SPDX-License-Identifier: Apache-2.0
#include "authoring/export/engine.h"

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

TEST(Engine, TraitsFollowTheOrderOfTheEnum) {
  for (std::size_t i = 0; i < Engines().size(); ++i) {
    EXPECT_EQ(Engines()[i].engine, static_cast<Engine>(i));
    EXPECT_EQ(&TraitsOf(static_cast<Engine>(i)), &Engines()[i]);
  }
  EXPECT_EQ(TraitsOf(Engine::kThree).name, "three");
}

TEST(Engine, OnlyUnrealPointsGreenDown) {
  for (const EngineTraits& traits : Engines()) {
    EXPECT_EQ(traits.green_down, traits.engine == Engine::kUnreal) << traits.name;
  }
}

TEST(Engine, PropertiesHaveLettersDigitsAndUnderscores) {
  EXPECT_EQ(PropertyName("brow_l.squash"), "furrow_brow_l_squash");
  EXPECT_EQ(PropertyName("knee-2.f\xc3\xa4lte"), "furrow_knee_2_f__lte");
}

TEST(Engine, ParametersFollowTheEngine) {
  EXPECT_EQ(ParameterName(Engine::kUnity, "a.b"), "_FurrowWeights");
  EXPECT_EQ(ParameterName(Engine::kUnreal, "a.b"), "a.b");
  EXPECT_EQ(ParameterName(Engine::kGodot, "a.b"), "furrow_a_b");
  EXPECT_EQ(ParameterName(Engine::kBlender, "a.b"), "furrow_a_b");
  EXPECT_EQ(ParameterName(Engine::kThree, "a.b"), "furrowWeights");
  EXPECT_EQ(ParameterName(Engine::kGeneric, "a.b"), "furrowWeights");
}

TEST(Engine, IdentifiersStartWithNoDigit) {
  EXPECT_EQ(Identifier("Skin head"), "Skin_head");
  EXPECT_EQ(Identifier("2nd"), "_2nd");
  EXPECT_EQ(Identifier(""), "_");
  EXPECT_EQ(Identifier("../../etc"), "______etc");
}

}  // namespace
}  // namespace furrow::authoring
