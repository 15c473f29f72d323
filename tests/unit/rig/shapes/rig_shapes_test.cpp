// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/rig_shapes.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/rig/shapes/shipped_shape_maps.h"

namespace furrow::rig {
namespace {

using testing::ElementsAre;

// A rig with drivers for these blend shapes and reference poses of these names.
wrinkle::Rig RigThatReads(const std::vector<std::string>& drivers,
                          const std::vector<std::string>& poses) {
  wrinkle::Rig rig;
  for (const std::string& name : drivers) {
    wrinkle::Driver& driver = rig.drivers.emplace_back();
    driver.name = name;
    driver.kind = wrinkle::Driver::Kind::kBlendShape;
    driver.blend_shape.blend_shape = name;
  }
  for (const std::string& name : poses) rig.reference_poses.emplace_back().name = name;
  return rig;
}

TEST(RigShapes, AStreamWithTheRigsNamesStaysAsItIs) {
  const std::vector<std::string> stream = {"JawOpen", "MouthSmileLeft", "BrowInnerUp", "HeadYaw"};
  const RigShapes shapes(ShippedShapeMatcher(), stream,
                         RigThatReads({"browInnerUp", "jawOpen", "tongueOut"}, {"mouthSmileLeft"}));
  EXPECT_EQ(shapes.size(), 4u);
  EXPECT_THAT(shapes.driver_names(), testing::ElementsAreArray(stream));
  EXPECT_THAT(shapes.pose_names(), testing::ElementsAreArray(stream));
  EXPECT_EQ(shapes.Description(), "");
}

TEST(RigShapes, PresetsFillDriversAndPosesBehindTheStream) {
  const std::vector<std::string> stream = {"Joy", "A", "Blink_L"};
  const RigShapes shapes(ShippedShapeMatcher(), stream,
                         RigThatReads({"mouthSmileLeft", "mouthSmileLeft", "eyeBlinkLeft"},
                                      {"jaw_open", "jawOpen", "eyeBlinkLeft", "blink_l"}));
  EXPECT_THAT(shapes.driver_names(),
              ElementsAre("Joy", "A", "Blink_L", "mouthSmileLeft", "eyeBlinkLeft", "", "", ""));
  // The stream's Blink_L has a pose of its own name, so it moves the lids by that alone.
  EXPECT_THAT(shapes.pose_names(), ElementsAre("Joy", "A", "Blink_L", "", "", "jawOpen", "", ""));
  wrinkle::LocalPose pose{.blend_shapes = {0.5f, 1.0f, 0.25f}};
  shapes.Extend(&pose);
  EXPECT_THAT(pose.blend_shapes, ElementsAre(0.5f, 1.0f, 0.25f, 0.5f, 0.25f, 0.8f, 0.0f, 0.25f));
  EXPECT_THAT(shapes.Description(), testing::HasSubstr("'vrm0' to 'arkit'"));
}

TEST(RigShapes, BadCoefficientsLeaveTheExtension) {
  const std::vector<std::string> stream = {"Joy", "A", "Blink"};
  const RigShapes shapes(ShippedShapeMatcher(), stream, RigThatReads({"jawOpen"}, {}));
  wrinkle::LocalPose pose{.blend_shapes = {0.0f, 1.0f, 0.0f}};
  shapes.Extend(&pose);
  ASSERT_EQ(pose.blend_shapes.size(), 4u);
  EXPECT_FLOAT_EQ(pose.blend_shapes[3], 0.8f);
  pose.blend_shapes[0] = std::numeric_limits<float>::quiet_NaN();
  pose.blend_shapes[1] = 0.0f;
  shapes.Extend(&pose);
  EXPECT_FLOAT_EQ(pose.blend_shapes[3], 0.8f);
}

TEST(RigShapes, ABodyHasNothingToTranslate) {
  const RigShapes shapes(ShippedShapeMatcher(), {}, RigThatReads({"jawOpen"}, {"jawOpen"}));
  EXPECT_EQ(shapes.size(), 0u);
  EXPECT_EQ(RigShapes().size(), 0u);
}

}  // namespace
}  // namespace furrow::rig
