// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/rig/full_pose.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/wrinkle/bound_rig.h"
#include "wrinkle/rig/driver_values.h"
#include "wrinkle/skeleton/reference_pose.h"

namespace furrow::wrinkle {
namespace {

using testing::HasSubstr;

const Driver& DriverOf(const Rig& rig, const std::string& name) {
  for (const Driver& driver : rig.drivers) {
    if (driver.name == name) return driver;
  }
  ADD_FAILURE() << name;
  return rig.drivers.front();
}

class FullPoses : public testing::TestWithParam<unsigned> {};

INSTANTIATE_TEST_SUITE_P(LocalFrames, FullPoses, testing::Values(0u, 31u, 32u));

// The definition: in the full pose of a value, the value is 1, whatever the joints' local frames.
TEST_P(FullPoses, MakeTheirValueOne) {
  const Rig rig = MakeRig();
  BoundRig bound(rig, MakeBody(GetParam()));
  int posed = 0;
  for (const Driver& driver : rig.drivers) {
    for (const std::string& value : DriverValueNames(driver)) {
      const auto pose = FullPose(rig, driver, value, bound.skeleton());
      if (!pose.ok()) {
        EXPECT_EQ(pose.status().code(), StatusCode::kUnsupported);
        EXPECT_TRUE(driver.kind == Driver::Kind::kBlendShape ||
                    driver.kind == Driver::Kind::kStrain);
        continue;
      }
      LocalPose locals = RestPose(bound.skeleton());
      ASSERT_TRUE(ApplyReferencePose(*pose, bound.skeleton(), locals.joints).ok());
      bound.Solve(locals);
      EXPECT_NEAR(bound.Value(driver.name + "." + value), 1.0f, 1e-4f) << pose->name;
      ++posed;
    }
  }
  EXPECT_EQ(posed, 5 + 2 + 8 + 2);
}

TEST(FullPose, ExtendedStraightensALimbThatRestsBent) {
  const Skeleton bent = MakeSkeleton({{"thigh_l", "", {0, 1, 0}, {}},
                                      {"shin_l", "thigh_l", {0, 0.5f, 0}, {}},
                                      {"foot_l", "shin_l", {0, 0.1f, -0.3f}, glm::vec3(0)}});
  Rig rig;
  rig.drivers = {DriverOf(MakeRig(), "knee_l")};
  BoundRig bound(rig, bent, {});
  LocalPose locals = RestPose(bent);
  EXPECT_LT(bound.ValueAt(locals, "knee_l.extended"), 0.95f);
  const auto pose = FullPose(rig, rig.drivers[0], "extended", bent);
  ASSERT_TRUE(pose.ok()) << pose.status().ToString();
  ASSERT_TRUE(ApplyReferencePose(*pose, bent, locals.joints).ok());
  EXPECT_NEAR(bound.ValueAt(locals, "knee_l.extended"), 1.0f, 1e-5f);
  // Without an axis it bends on the way it is bent.
  rig.drivers[0].hinge.axis.reset();
  BoundRig axisless(rig, bent, {});
  const auto flexed = FullPose(rig, rig.drivers[0], "flexed", bent);
  ASSERT_TRUE(flexed.ok());
  locals = RestPose(bent);
  ASSERT_TRUE(ApplyReferencePose(*flexed, bent, locals.joints).ok());
  EXPECT_NEAR(axisless.ValueAt(locals, "knee_l.flexed"), 1.0f, 1e-4f);
}

// With a stated bone, "extended" is that direction, and full flexion counts from it.
TEST(FullPose, CountsFromTheStatedBone) {
  Rig rig = MakeRig();
  rig.drivers = {DriverOf(rig, "knee_l")};
  rig.regions.clear();
  rig.drivers[0].hinge.bone = glm::vec3(0.0f, -2.0f, -0.7f);
  for (const bool has_axis : {true, false}) {
    if (!has_axis) rig.drivers[0].hinge.axis.reset();
    BoundRig bound(rig, MakeBody(31), {});
    for (const std::string value : {"flexed", "extended"}) {
      const auto pose = FullPose(rig, rig.drivers[0], value, bound.skeleton());
      ASSERT_TRUE(pose.ok()) << pose.status().ToString();
      LocalPose locals = RestPose(bound.skeleton());
      ASSERT_TRUE(ApplyReferencePose(*pose, bound.skeleton(), locals.joints).ok());
      EXPECT_NEAR(bound.ValueAt(locals, "knee_l." + value), 1.0f, 1e-4f);
    }
  }
}

TEST(FullPose, FoldsOntoItselfWhereBetaIsNone) {
  Rig rig = MakeRig();
  Driver knee = DriverOf(rig, "knee_l");
  knee.hinge.beta_degrees = 0.0f;
  const auto pose = FullPose(rig, knee, "flexed", MakeBody());
  ASSERT_TRUE(pose.ok());
  const glm::vec3 shin = pose->joints[0].rotation * glm::vec3(0, -1, 0);
  EXPECT_NEAR(shin.y, 1.0f, 1e-4f);
  EXPECT_NEAR(std::abs(pose->joints[0].rotation.x), 1.0f, 1e-2f);  // about the axis
}

TEST(FullPose, ASideOfABallBendsToItsOwnLimit) {
  const Rig rig = MakeRig();
  Driver hip = DriverOf(rig, "hip_l");
  hip.ball.back.limit_degrees = 40.0f;
  const auto pose = FullPose(rig, hip, "back", MakeBody());
  ASSERT_TRUE(pose.ok());
  const glm::vec3 thigh = pose->joints[0].rotation * glm::vec3(0, -1, 0);
  EXPECT_NEAR(thigh.y, -0.7660444f, 1e-3f);  // -cos 40
  EXPECT_LT(thigh.z, 0.0f);
}

TEST(FullPose, SaysWhyThereIsNone) {
  const Rig rig = MakeRig();
  const Skeleton body = MakeBody();
  const auto fails = [&](Driver driver, const std::string& value) {
    return FullPose(rig, driver, value, body).status();
  };
  EXPECT_EQ(fails(DriverOf(rig, "jaw"), "value").code(), StatusCode::kUnsupported);
  EXPECT_EQ(fails(DriverOf(rig, "knee_l"), "bent").code(), StatusCode::kNotFound);
  Driver knee = DriverOf(rig, "knee_l");
  knee.hinge.axis.reset();
  EXPECT_THAT(fails(knee, "flexed").what(),
              HasSubstr("driver 'knee_l' cannot be posed: it states no axis"));
  knee.hinge.joint = "knee";
  EXPECT_THAT(fails(knee, "flexed").what(), HasSubstr("names joint 'knee'"));
  Driver hip = DriverOf(rig, "hip_l");
  hip.ball.forward = {0, 1, 0};
  EXPECT_THAT(fails(hip, "front").what(), HasSubstr("forward lies along"));
  // Within 6 degrees of the bone the solver refuses it, too.
  hip.ball.forward = {0, 1, 0.05f};
  EXPECT_THAT(fails(hip, "front").what(), HasSubstr("forward lies along"));
  knee = DriverOf(rig, "knee_l");
  knee.hinge.axis = glm::vec3(0.05f, 1, 0);
  EXPECT_THAT(fails(knee, "flexed").what(), HasSubstr("its axis lies along"));
  knee.hinge.axis = glm::vec3(0.2f, 1, 0);
  EXPECT_TRUE(FullPose(rig, knee, "flexed", body).ok());
  Driver brow = DriverOf(rig, "brow_l");
  brow.pose.values[0].reference_pose = "shock";
  EXPECT_THAT(fails(brow, "stretch").what(), HasSubstr("reference pose 'shock'"));
}

}  // namespace
}  // namespace furrow::wrinkle
