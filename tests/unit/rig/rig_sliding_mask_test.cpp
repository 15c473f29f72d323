// SPDX-License-Identifier: Apache-2.0
// Reads and writes masks that slide around a joint.
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "rig/rig_file.h"

namespace furrow::rig {
namespace {

// A rig for a hip with a sliding mask. `mask`: more fields of the mask, each after a comma.
Result<wrinkle::Rig> ParseMask(const std::string& mask) {
  const std::string json = R"({"name": "hip", "drivers": [
      {"name": "hip_l", "ball": {"parent": "hips", "joint": "thigh_l"}},
      {"name": "knee_l", "hinge": {"parent": "thigh_l", "joint": "shin_l"}},
      {"name": "elbow_l", "hinge": {"parent": "arm_l", "joint": "forearm_l", "axis": [0, -1, 0]}},
      {"name": "neck", "twist": {"joint": "neck"}},
      {"name": "blink", "blend_shape": {"blend_shape": "eyeBlinkLeft"}}],
    "wrinkle_maps": [{"name": "folds", "normal": "folds.png"}],
    "regions": [{"name": "hip_l", "combine": "sum", "mask": {"kind": "sliding")" +
                           mask + R"(},
      "feeds": [{"map": "folds", "sources": [{"from": "hip_l.front"}, {"from": "hip_l.left"}]}]}]})";
  return ParseRig(json, "hip.rig.json", ".");
}

TEST(SlidingMaskInARig, ReadsDefaultsAndWritesBack) {
  const auto rig = ParseMask(R"(, "driver": "hip_l", "spread_degrees": 70, "radius": 0.6)");
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  const wrinkle::Mask& mask = rig->regions[0].mask;
  EXPECT_EQ(mask.kind, wrinkle::Mask::Kind::kSliding);
  EXPECT_EQ(mask.driver, "hip_l");
  EXPECT_EQ(mask.spread_degrees, 70.0f);
  EXPECT_EQ(mask.above, 0.15f);
  EXPECT_EQ(mask.below, 0.4f);
  EXPECT_EQ(mask.radius, 0.6f);
  const auto again = ParseRig(RigToJson(*rig), "again.rig.json", ".");
  ASSERT_TRUE(again.ok()) << again.status().ToString();
  EXPECT_EQ(again->regions[0].mask.kind, wrinkle::Mask::Kind::kSliding);
  EXPECT_EQ(again->regions[0].mask.driver, "hip_l");
  EXPECT_EQ(again->regions[0].mask.radius, 0.6f);
}

TEST(SlidingMaskInARig, ReadsTheFormerNameOfItsDriver) {
  const auto rig = ParseMask(R"(, "ball": "hip_l")");
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  EXPECT_EQ(rig->regions[0].mask.driver, "hip_l");
  EXPECT_NE(RigToJson(*rig).find(R"("driver": "hip_l")"), std::string::npos);
  const Status both = ParseMask(R"(, "ball": "hip_l", "driver": "hip_l")").status();
  EXPECT_EQ(both.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(both.where().find("regions[0].mask.ball"), std::string::npos) << both.ToString();
}

TEST(SlidingMaskInARig, AcceptsEveryDriverWithADirection) {
  for (const char* driver : {"hip_l", "elbow_l", "neck"}) {
    const auto rig = ParseMask(std::string(R"(, "driver": ")") + driver + "\"");
    EXPECT_TRUE(rig.ok()) << rig.status().ToString();
  }
}

TEST(SlidingMaskInARig, SaysWhyADriverHasNoDirection) {
  const std::pair<const char*, const char*> wrongs[] = {
      {"", "a sliding mask names a driver of the rig"},
      {R"(, "driver": "waist")", "a sliding mask names a driver of the rig"},
      {R"(, "driver": "knee_l")", "a hinge without an axis has no direction"},
      {R"(, "driver": "blink")", "this kind of driver has no direction"}};
  for (const auto& [mask, why] : wrongs) {
    const Status status = ParseMask(mask).status();
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument) << mask;
    EXPECT_EQ(status.what(), why);
    EXPECT_NE(status.where().find("regions[0].mask.driver"), std::string::npos)
        << status.ToString();
  }
}

TEST(SlidingMaskInARig, RequiresAnExtent) {
  for (const char* mask :
       {R"(, "driver": "hip_l", "radius": 0)", R"(, "driver": "hip_l", "spread_degrees": 181)",
        R"(, "driver": "hip_l", "above": 0, "below": 0)"}) {
    const Status status = ParseMask(mask).status();
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument) << mask;
    EXPECT_NE(status.ToString().find("regions[0].mask"), std::string::npos) << status.ToString();
  }
}

}  // namespace
}  // namespace furrow::rig
