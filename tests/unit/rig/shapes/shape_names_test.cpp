// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/shape_names.h"

#include <vector>

#include <gtest/gtest.h>

#include "rig/shapes/arkit_shapes.h"

namespace furrow::rig {
namespace {

TEST(ShapeNames, SpellingsOfOneShapeHaveOneForm) {
  for (const char* name :
       {"browDownLeft", "BrowDownLeft", "browDown_L", "brow_down_left", "Brow Down L",
        "BROW-DOWN-L", "head_geo.browDownLeft", "rig:face|browDown_L", "browDownLeft.001",
        "Brow_L_Down", "browdownleft"}) {
    EXPECT_EQ(NormalShapeName(name), "browdownleft") << name;
  }
  EXPECT_NE(NormalShapeName("browDownRight"), NormalShapeName("browDownLeft"));
}

TEST(ShapeNames, TwoSidesKeepTheirOrder) {
  EXPECT_EQ(NormalShapeName("Eye_L_Look_R"), "eyeleftlookright");
  EXPECT_EQ(NormalShapeName("eyeLookRightL"), "eyelookrightleft");
  EXPECT_NE(NormalShapeName("Eye_Left_Right"), NormalShapeName("Eye_Right_Left"));
}

TEST(ShapeNames, NumbersLoseLeadingZeros) {
  EXPECT_EQ(NormalShapeName("AU01_L"), "au1left");
  EXPECT_EQ(NormalShapeName("AU1L"), "au1left");
  EXPECT_EQ(NormalShapeName("AU10"), "au10");
  EXPECT_EQ(NormalShapeName("AU_0"), "au0");
}

TEST(ShapeNames, PrefixesAreCutOnce) {
  const std::vector<std::string> prefixes = {"A##_", "*Fcl_", "BS_"};
  EXPECT_EQ(WithoutShapePrefix("A01_Brow", prefixes), "Brow");
  EXPECT_EQ(WithoutShapePrefix("AB1_Brow", prefixes), "AB1_Brow");
  EXPECT_EQ(WithoutShapePrefix("M_F00_fcl_ALL", prefixes), "ALL");
  EXPECT_EQ(WithoutShapePrefix("bs_BS_x", prefixes), "BS_x");
  EXPECT_EQ(WithoutShapePrefix("BS_", prefixes), "BS_");
}

TEST(ShapeNames, OddNamesAreHarmless) {
  for (const char* name : {"", ".", "::", "|", "_", "1", ".5", "a.", "L", "\xff\xfe", "..001"}) {
    (void)NormalShapeName(name);
    (void)ShapeNameCore(name);
  }
  EXPECT_EQ(NormalShapeName("L"), "left");
  EXPECT_EQ(ShapeNameCore("vrc.v_aa"), "v_aa");
}

TEST(ArkitShapes, MirrorsAreMutual) {
  for (int shape = 0; shape < kNumArkitShapes; ++shape) {
    const int mirrored = MirroredArkitShape(shape);
    ASSERT_GE(mirrored, 0);
    EXPECT_EQ(MirroredArkitShape(mirrored), shape);
    const bool has_side =
        ArkitShapes()[shape].ends_with("Left") || ArkitShapes()[shape].ends_with("Right");
    EXPECT_EQ(mirrored == shape, !has_side) << ArkitShapes()[shape];
  }
  EXPECT_EQ(FindArkitShape("JAWOPEN"), 17);
  EXPECT_EQ(FindArkitShape("jaw"), -1);
}

}  // namespace
}  // namespace furrow::rig
