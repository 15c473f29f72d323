// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/rig/rig_blend_shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/wrinkle/test_characters.h"

namespace furrow::wrinkle {
namespace {

using ::testing::ElementsAre;

Driver Reads(const std::string& blend_shape) {
  Driver driver;
  driver.name = "reads_" + blend_shape;
  driver.kind = Driver::Kind::kBlendShape;
  driver.blend_shape.blend_shape = blend_shape;
  return driver;
}

TEST(RigBlendShapes, AreThoseOfAllKindsOnce) {
  Rig rig;
  rig.drivers = {CheekPatch(), Reads("jawOpen"), Reads("JAWOPEN")};
  rig.drivers[0].strain.shapes = {{"puff", {0}, {1, 0, 0}}, {"jawopen", {0}, {0, 1, 0}}};
  EXPECT_THAT(BlendShapesOf(rig), ElementsAre("puff", "jawopen"));
  rig.drivers[0].kind = Driver::Kind::kHinge;  // only the kind's own fields count
  EXPECT_THAT(BlendShapesOf(rig), ElementsAre("jawOpen"));
}

TEST(RigBlendShapes, IncludeThePointsOfPoseDrivers) {
  Rig rig;
  rig.drivers.resize(1);
  rig.drivers[0].pose.points = {
      {.joint = "brow"},
      {.joint = "", .kind = ControlPoint::Kind::kBlendShape, .blend_shape = "browInnerUp"}};
  EXPECT_THAT(BlendShapesOf(rig), ElementsAre("browInnerUp"));
}

TEST(RigBlendShapes, AreFoundInAnyCase) {
  Rig rig;
  EXPECT_FALSE(ReadsAny(rig, std::vector<std::string>{"jawOpen"}));
  rig.drivers = {Reads("jawOpen")};
  EXPECT_TRUE(ReadsAny(rig, std::vector<std::string>{"smile", "JawOpen"}));
  EXPECT_FALSE(ReadsAny(rig, std::vector<std::string>{"smile"}));
  EXPECT_FALSE(ReadsAny(rig, {}));
}

}  // namespace
}  // namespace furrow::wrinkle
