// SPDX-License-Identifier: Apache-2.0
#include "tests/observer/fold_cases.h"

#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/render/character_parts.h"

namespace furrow::observer {
namespace {

using render::test::Joint;
using testing::ElementsAre;

wrinkle::Region RegionOf(const std::string& name, const std::vector<wrinkle::Feed>& feeds) {
  wrinkle::Region region;
  region.name = name;
  region.mask.texture = "masks";
  region.modulation = wrinkle::Modulation::kLinear;
  region.feeds = feeds;
  return region;
}

// A brow that moves up, and a straight left arm along +X whose elbow folds two maps inside and one
// outside. The outside folds while the arm is straight.
character::Character MakeArm() {
  character::Character character;
  render::test::SetSkeleton({Joint("root", -1, {0, 1, 0}), Joint("brow", 0, {0, 0.6f, 0.1f}),
                             Joint("upper", 0, {0.2f, 0.4f, 0}), Joint("lower", 2, {0.3f, 0, 0}),
                             Joint("hand", 3, {0.25f, 0, 0})},
                            &character);
  wrinkle::Rig& rig = character.rig;
  rig.anchor = "root";
  wrinkle::ReferencePose raise;
  raise.name = "raise";
  raise.joints.push_back({.joint = "brow", .translation = {0, 0.01f, 0}});
  rig.reference_poses.push_back(raise);
  wrinkle::Driver brow;
  brow.name = "brow";
  brow.kind = wrinkle::Driver::Kind::kPose;
  brow.pose.points.push_back({.joint = "brow", .kind = wrinkle::ControlPoint::Kind::kOrigin});
  brow.pose.values.push_back({.name = "up", .reference_pose = "raise"});
  rig.drivers.push_back(brow);
  wrinkle::Driver elbow;
  elbow.name = "elbow";
  elbow.kind = wrinkle::Driver::Kind::kHinge;
  elbow.hinge.parent = "upper";
  elbow.hinge.joint = "lower";
  elbow.hinge.end = "hand";
  elbow.hinge.axis = glm::vec3(0, -1, 0);
  rig.drivers.push_back(elbow);
  wrinkle::Driver shape;
  shape.name = "browUp";
  shape.kind = wrinkle::Driver::Kind::kBlendShape;
  shape.blend_shape.blend_shape = "browUp";
  rig.drivers.push_back(shape);
  for (const char* map : {"lines", "small", "large"}) {
    wrinkle::WrinkleMap one;
    one.name = map;
    one.normal = map;
    if (rig.wrinkle_maps.empty()) {
      one.surface = wrinkle::WrinkleMap::Surface::kSkin;
    } else {
      one.surface = wrinkle::WrinkleMap::Surface::kCloth;
    }
    rig.wrinkle_maps.push_back(one);
  }
  wrinkle::Feed straight{"large", {{"elbow", "extended", 1.0f}}};
  rig.regions = {
      RegionOf("forehead", {{"lines", {{"browUp", "value", 1.0f}, {"brow", "up", 0.5f}}}}),
      RegionOf("outside", {straight}),
      RegionOf("inside",
               {{"small", {{"elbow", "flexed", 0.5f}}}, {"large", {{"elbow", "flexed", 1.0f}}}})};
  return character;
}

template <class T>
T Take(Result<T> result) {
  EXPECT_TRUE(result.ok()) << result.status().ToString();
  return result.ok() ? *result : T();
}

TEST(FaceCases, RaisesOneWeightInItsOwnPose) {
  const character::Character arm = MakeArm();
  const auto cases = Take(FaceCases(arm));
  ASSERT_EQ(cases.size(), 1u);
  EXPECT_EQ(cases[0].name, "forehead.lines");
  EXPECT_THAT(cases[0].regions, ElementsAre(0u));
  EXPECT_THAT(cases[0].wrinkle_weights, ElementsAre(1.0f, 0.0f, 0.0f, 0.0f));
  // The blend shape is the stronger source, but poses no joint.
  EXPECT_NEAR(cases[0].pose.joints[1].translation.y, 0.61f, 1e-5f);
}

TEST(FaceCases, PosesShapesOfTheCharacter) {
  character::Character arm = MakeArm();
  arm.shapes = {"jawOpen", "BrowUp"};
  const auto cases = Take(FaceCases(arm));
  ASSERT_EQ(cases.size(), 1u);
  EXPECT_THAT(cases[0].shapes, ElementsAre(0.0f, 1.0f));
  EXPECT_NEAR(cases[0].pose.joints[1].translation.y, 0.6f, 1e-5f);
}

TEST(FaceCases, RestsWithoutAPose) {
  character::Character arm = MakeArm();
  arm.rig.regions[0].feeds[0].sources.pop_back();
  const auto cases = Take(FaceCases(arm));
  ASSERT_EQ(cases.size(), 1u);
  EXPECT_NEAR(cases[0].pose.joints[1].translation.y, 0.6f, 1e-5f);
}

TEST(BendCases, BendsAJointWithAllOfItsRegions) {
  const character::Character arm = MakeArm();
  std::vector<std::string> unfolded;
  const auto cases = Take(BendCases(arm, &unfolded));
  ASSERT_EQ(cases.size(), 1u);  // "extended" is the rest pose, not a bend
  EXPECT_EQ(cases[0].name, "elbow.flexed");
  EXPECT_THAT(cases[0].regions, ElementsAre(1u, 2u));
  ASSERT_EQ(cases[0].wrinkle_weights.size(), 4u);
  EXPECT_EQ(cases[0].wrinkle_weights[0], 0.0f);
  EXPECT_NEAR(cases[0].wrinkle_weights[1], 0.0f, 1e-5f);
  EXPECT_NEAR(cases[0].wrinkle_weights[2], 0.5f, 1e-5f);
  EXPECT_NEAR(cases[0].wrinkle_weights[3], 1.0f, 1e-5f);
  EXPECT_EQ(cases[0].side, 1);
  EXPECT_THAT(unfolded, testing::IsEmpty());
}

TEST(BendCases, ListsBendsThatTheRigDoesNotFold) {
  character::Character arm = MakeArm();
  arm.rig.regions.pop_back();
  // The outside folds while the arm is straight, and it names the bend as a source that ends.
  wrinkle::Feed& feed = arm.rig.regions[1].feeds[0];
  feed.sources = {{"elbow", "flexed", 1.0f}};
  feed.curve = {{0.0f, 1.0f}, {0.9f, 0.0f}};
  std::vector<std::string> unfolded;
  EXPECT_TRUE(Take(BendCases(arm, &unfolded)).empty());
  EXPECT_THAT(unfolded, ElementsAre("elbow.flexed"));
  EXPECT_TRUE(Take(BendCases(arm, nullptr)).empty());
}

TEST(FaceCases, ReportsAMissingPose) {
  character::Character arm = MakeArm();
  arm.rig.drivers[0].pose.values[0].reference_pose = "lower";
  EXPECT_EQ(FaceCases(arm).status().code(), StatusCode::kNotFound);
}

}  // namespace
}  // namespace furrow::observer
