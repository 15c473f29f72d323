// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/shape_map_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/rig/shapes/shipped_shape_maps.h"

namespace furrow::rig {
namespace {

using testing::Contains;
using testing::HasSubstr;

ShapeMap MapWith(const std::string& shapes) {
  return ParseShapeMap(R"({"version": 1, "name": "toy", "shapes": )" + shapes + "}", "toy").value();
}

TEST(ShapeMapCheck, ShippedMapsHaveNoWarnings) {
  for (const ShapeMap& map : ShippedShapeMaps()) {
    const ShapeMapReport report = CheckShapeMap(map);
    EXPECT_THAT(report.warnings, testing::IsEmpty()) << map.name;
    EXPECT_EQ(report.num_shapes, map.shapes.size());
  }
}

TEST(ShapeMapCheck, FindsFormulasThatAreNotMirrored) {
  const auto report = CheckShapeMap(MapWith(
      R"({"grin_L": "mouthSmileLeft", "grin_R": "0.5 mouthSmileRight", "wink_L": "eyeBlinkLeft"})"));
  EXPECT_THAT(report.warnings, Contains(HasSubstr("'grin_L' and 'grin_R' are not mirror images")));
  EXPECT_THAT(report.warnings, Contains(HasSubstr("'wink_L' has no counterpart")));
}

TEST(ShapeMapCheck, FindsShapesThatFallWhileTheyRise) {
  const auto report = CheckShapeMap(MapWith(R"({"gape": ["2 jawOpen", "-2 jawOpen jawOpen"]},
      "arkit": {"jawOpen": "gape", "tongueOut": "gape"})"));
  EXPECT_THAT(report.warnings, Contains(HasSubstr("'jawOpen' falls while it rises")));
  EXPECT_THAT(report.one_way, testing::ElementsAre("tongueOut"));
  EXPECT_EQ(report.not_covered.size(), 50u);
  EXPECT_THAT(ToText(report), HasSubstr("2 of ARKit's 52 blend shapes"));
}

TEST(ShapeMapProposal, KnowsWhatShippedMapsKnow) {
  const std::string text =
      ProposeShapeMap("mine",
                      std::vector<std::string>{"jaw_Open", "JawOpen", "Joy", "hat \"x\"",
                                               "CTRL_expressions_mouthFunnelUL", "", "a*b"},
                      ShippedShapeMaps());
  const auto map = ParseShapeMap(text, "proposal");
  ASSERT_TRUE(map.ok()) << map.status().ToString() << text;
  EXPECT_EQ(map->name, "mine");
  EXPECT_THAT(NamesOf(*map), testing::UnorderedElementsAre("jaw_Open", "Joy", "hat \"x\"",
                                                           "CTRL_expressions_mouthFunnelUL"));
  EXPECT_THAT(text, HasSubstr("\"jaw_Open\": \"jawOpen\""));
  EXPECT_THAT(text, HasSubstr("[\"mouthFunnel\", \"0.75 mouthPucker\"]"));
  EXPECT_THAT(text, HasSubstr("\"hat \\\"x\\\"\": []"));
}

}  // namespace
}  // namespace furrow::rig
