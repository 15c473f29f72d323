// SPDX-License-Identifier: Apache-2.0
#include "authoring/shapes/shape_finder.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "authoring/shapes/shape_combinations.h"
#include "rig/shapes/arkit_shapes.h"

namespace furrow::authoring {
namespace {

TEST(ShapeFinder, SpellingsOfOneShapeHaveOneKey) {
  for (const char* name : {"mouthSmileLeft", "mouthSmile_L", "MouthSmileLeft", "Mouth_Smile_Left",
                           "head|mouthSmileLeft", "Face.M_F00:Mouth Smile L", "mouth-smile-l"}) {
    EXPECT_EQ(ShapeKey(name), "mouthsmileleft") << name;
  }
}

// A direction is not a side, and a last letter is not a side unless it stands apart.
TEST(ShapeFinder, OtherShapesKeepOtherKeys) {
  EXPECT_EQ(ShapeKey("mouthLeft"), "mouthleft");
  EXPECT_NE(ShapeKey("mouthFunnel"), ShapeKey("mouthFunne_L"));
  EXPECT_EQ(ShapeKey("browInnerUp"), "browinnerup");
  std::set<std::string> keys;
  for (const std::string_view name : rig::ArkitShapes())
    EXPECT_TRUE(keys.insert(ShapeKey(name)).second) << name;
  EXPECT_EQ(keys.size(), 52u);
}

TEST(ShapeFinder, ReturnsMinusOneForUnknownNames) {
  character::Character character;
  character.shapes = {"jawOpen", "browDown_L"};
  const ShapeFinder find = FindShapesByName(character);
  EXPECT_EQ(find("browDownLeft"), 1);
  EXPECT_EQ(find("browDownRight"), -1);
  EXPECT_EQ(find(""), -1);
}

TEST(ShapeCombinations, NameOnlyShapesOfArkit) {
  std::set<std::string> known;
  for (const std::string_view name : rig::ArkitShapes()) known.insert(std::string(name));
  for (const ShapeCombination& combination : ShapeCombinations()) {
    bool leads = false;
    for (const ShapeCombination::Part& part : combination.parts) {
      leads = leads || std::string(part.shape) == combination.lead;
      EXPECT_GT(part.weight, 0.0f);
      EXPECT_LE(part.weight, 1.0f);
      for (const std::string& name : ShapesOf(part.shape)) {
        EXPECT_TRUE(known.contains(name)) << name;
      }
    }
    EXPECT_TRUE(leads) << combination.lead;
  }
}

}  // namespace
}  // namespace furrow::authoring
