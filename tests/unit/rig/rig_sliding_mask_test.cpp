// SPDX-License-Identifier: Apache-2.0
// Reads and writes masks that slide around a ball joint.
#include <string>

#include <gtest/gtest.h>

#include "rig/rig_file.h"

namespace furrow::rig {
namespace {

// A rig for a hip with a sliding mask. `mask`: more fields of the mask, each after a comma.
Result<wrinkle::Rig> Parse(const std::string& mask) {
  const std::string json = R"({"name": "hip", "drivers": [
      {"name": "hip_l", "ball": {"parent": "hips", "joint": "thigh_l"}},
      {"name": "knee_l", "hinge": {"parent": "thigh_l", "joint": "shin_l"}}],
    "wrinkle_maps": [{"name": "folds", "normal": "folds.png"}],
    "regions": [{"name": "hip_l", "combine": "sum", "mask": {"kind": "sliding")" +
                           mask + R"(},
      "feeds": [{"map": "folds", "sources": [{"from": "hip_l.front"}, {"from": "hip_l.left"}]}]}]})";
  return ParseRig(json, "hip.rig.json", ".");
}

TEST(SlidingMaskInARig, ReadsDefaultsAndWritesBack) {
  const auto rig = Parse(R"(, "ball": "hip_l", "spread_degrees": 70, "radius": 0.6)");
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  const wrinkle::Mask& mask = rig->regions[0].mask;
  EXPECT_EQ(mask.kind, wrinkle::Mask::Kind::kSliding);
  EXPECT_EQ(mask.ball, "hip_l");
  EXPECT_EQ(mask.spread_degrees, 70.0f);
  EXPECT_EQ(mask.above, 0.15f);
  EXPECT_EQ(mask.below, 0.4f);
  EXPECT_EQ(mask.radius, 0.6f);
  const auto again = ParseRig(RigToJson(*rig), "again.rig.json", ".");
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  EXPECT_EQ(again->regions[0].mask.kind, wrinkle::Mask::Kind::kSliding);
  EXPECT_EQ(again->regions[0].mask.ball, "hip_l");
  EXPECT_EQ(again->regions[0].mask.radius, 0.6f);
}

TEST(SlidingMaskInARig, RequiresABallDriverAndAnExtent) {
  for (const char* mask :
       {"", R"(, "ball": "waist")", R"(, "ball": "knee_l")", R"(, "ball": "hip_l", "radius": 0)",
        R"(, "ball": "hip_l", "spread_degrees": 181)",
        R"(, "ball": "hip_l", "above": 0, "below": 0)"}) {
    const Status status = Parse(mask).status();
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument) << mask;
    EXPECT_NE(status.ToString().find("regions[0].mask"), std::string::npos) << status.ToString();
  }
}

}  // namespace
}  // namespace furrow::rig
