// SPDX-License-Identifier: Apache-2.0
// Hinge, ball, twist and blend-shape drivers on a body, whatever its local frames.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "tests/unit/wrinkle/bound_rig.h"

namespace furrow::wrinkle {
namespace {

const glm::vec3 kX(1.0f, 0.0f, 0.0f);
const glm::vec3 kY(0.0f, 1.0f, 0.0f);
const glm::vec3 kZ(0.0f, 0.0f, 1.0f);

class ClothingDrivers : public testing::TestWithParam<unsigned> {
 protected:
  LocalPose Turned(const std::string& joint, float degrees, const glm::vec3& axis) {
    LocalPose pose = RestPose(rig_.skeleton());
    Turn(rig_.skeleton(), joint, AngleAxis(degrees, axis), &pose);
    return pose;
  }
  BoundRig rig_{MakeRig(), MakeBody(GetParam())};
};

INSTANTIATE_TEST_SUITE_P(LocalFrames, ClothingDrivers, testing::Values(0u, 31u, 32u));

TEST_P(ClothingDrivers, KneeGivesTheWorkedValues) {
  EXPECT_NEAR(rig_.ValueAt(Turned("shin_l", 0.0f, kX), "knee_l.flexed"), 0.0f, 1e-6f);
  EXPECT_NEAR(rig_.Value("knee_l.extended"), 1.0f, 1e-6f);
  EXPECT_NEAR(rig_.ValueAt(Turned("shin_l", 45.0f, kX), "knee_l.flexed"), 0.157f, 5e-4f);
  EXPECT_NEAR(rig_.ValueAt(Turned("shin_l", 90.0f, kX), "knee_l.flexed"), 0.536f, 5e-4f);
  EXPECT_NEAR(rig_.Value("knee_l.extended"), 0.464f, 5e-4f);
  EXPECT_NEAR(rig_.ValueAt(Turned("shin_l", 150.0f, kX), "knee_l.flexed"), 1.0f, 1e-5f);
  EXPECT_NEAR(rig_.ValueAt(Turned("shin_l", -20.0f, kX), "knee_l.flexed"), 0.0f, 1e-6f);
}

TEST_P(ClothingDrivers, KneeDoesNotCareForTheHip) {
  LocalPose pose = Turned("shin_l", 90.0f, kX);
  Turn(rig_.skeleton(), "thigh_l", AngleAxis(77.0f, {0.3f, -1.0f, 0.4f}), &pose);
  EXPECT_NEAR(rig_.ValueAt(pose, "knee_l.flexed"), 0.536f, 5e-4f);
}

TEST_P(ClothingDrivers, WithoutAnAxisHyperextensionReadsAsFlexion) {
  Rig unsigned_rig = MakeRig();
  for (Driver& driver : unsigned_rig.drivers) driver.hinge.axis.reset();
  BoundRig rig(unsigned_rig, MakeBody(GetParam()));
  EXPECT_NEAR(rig.ValueAt(Turned("shin_l", -45.0f, kX), "knee_l.flexed"), 0.157f, 5e-4f);
}

TEST_P(ClothingDrivers, EndReplacesTheTail) {
  Rig to_foot = MakeRig();
  for (Driver& driver : to_foot.drivers) {
    if (driver.name == "knee_l") driver.hinge.end = "foot_l";
  }
  BoundRig rig(to_foot, MakeBody(GetParam()));
  EXPECT_NEAR(rig.ValueAt(Turned("shin_l", 90.0f, kX), "knee_l.flexed"), 0.536f, 5e-4f);
}

TEST_P(ClothingDrivers, HipTellsTheDirectionOfTheLeg) {
  // Turning right-handed about -x lifts the hanging leg forward; about +z it swings to +x, which is
  // the left of a character that faces +z.
  const float at_90 = 0.5358984f;
  rig_.Solve(Turned("thigh_l", -90.0f, kX));
  EXPECT_NEAR(rig_.Value("hip_l.front"), at_90, 1e-4f);
  EXPECT_NEAR(rig_.Value("hip_l.back"), 0.0f, 1e-6f);
  rig_.Solve(Turned("thigh_l", 30.0f, kX));
  EXPECT_GT(rig_.Value("hip_l.back"), 0.05f);
  EXPECT_NEAR(rig_.Value("hip_l.front"), 0.0f, 1e-6f);
  rig_.Solve(Turned("thigh_l", 90.0f, kZ));
  EXPECT_NEAR(rig_.Value("hip_l.left"), at_90, 1e-4f);
  EXPECT_NEAR(rig_.Value("hip_l.right"), 0.0f, 1e-5f);
  rig_.Solve(Turned("thigh_l", -45.0f, kZ));
  EXPECT_NEAR(rig_.Value("hip_l.right"), 0.1569609f, 1e-4f);
}

TEST_P(ClothingDrivers, WaistTellsLeftFromRightThoughItsBonePointsUp) {
  rig_.Solve(Turned("spine", 45.0f, kX));  // bowing
  EXPECT_NEAR(rig_.Value("waist.front"), 0.157f, 5e-4f);
  rig_.Solve(Turned("spine", -45.0f, kZ));  // leaning towards +x, the subject's left
  EXPECT_NEAR(rig_.Value("waist.left"), 0.157f, 5e-4f);
  EXPECT_NEAR(rig_.Value("waist.right"), 0.0f, 1e-6f);
}

TEST_P(ClothingDrivers, BallSumsToTheBendAroundTheBone) {
  for (float psi = 0.0f; psi < 360.0f; psi += 7.5f) {
    const float a = glm::radians(psi);
    rig_.Solve(Turned("thigh_l", 60.0f, {std::cos(a), 0.0f, std::sin(a)}));
    const float sum = rig_.Value("hip_l.front") + rig_.Value("hip_l.back") +
                      rig_.Value("hip_l.left") + rig_.Value("hip_l.right");
    EXPECT_NEAR(sum, 0.5f * 0.5358984f, 1e-4f);
  }
}

TEST_P(ClothingDrivers, BallWithoutABoneTakesTheParentsOwnDirection) {
  Rig own = MakeRig();
  for (Driver& driver : own.drivers) {
    if (driver.name != "hip_l") continue;
    driver.ball = {.parent = "thigh_l", .joint = "shin_l", .end = {}};
  }
  BoundRig rig(own, MakeBody(GetParam()));
  rig.Solve(Turned("thigh_l", -60.0f, kX));
  EXPECT_NEAR(rig.Value("hip_l.front"), 0.0f, 1e-5f);  // the whole leg, not the knee
  rig.Solve(Turned("shin_l", -90.0f, kX));
  EXPECT_NEAR(rig.Value("hip_l.front"), 0.536f, 5e-4f);
}

TEST_P(ClothingDrivers, BallSweepIsContinuous) {
  float worst = 0.0f;
  std::vector<float> before;
  for (int i = -1500; i <= 1500; ++i) {
    rig_.Solve(Turned("thigh_l", static_cast<float>(i) * 0.1f, {1.0f, 0.0f, 0.3f}));
    for (std::size_t k = 0; k < before.size(); ++k) {
      worst = std::max(worst, std::abs(rig_.values()[k] - before[k]));
    }
    before = rig_.values();
  }
  std::printf("ball, through the range: at most %.6f per 0.1 degree\n", worst);
  EXPECT_LE(worst, 0.00096f);  // sin(90) / (1 + cos(30)) per radian, and no more
}

TEST_P(ClothingDrivers, TwistAddsUpOverItsJoints) {
  LocalPose pose = Turned("neck", 20.0f, kY);
  Turn(rig_.skeleton(), "neck_upper", AngleAxis(25.0f, kY), &pose);
  rig_.Solve(pose);
  EXPECT_NEAR(rig_.Value("neck.twist_left"), 0.5f, 1e-4f);
  EXPECT_EQ(rig_.Value("neck.twist_right"), 0.0f);
  Turn(rig_.skeleton(), "neck_upper", AngleAxis(-65.0f, kY), &pose);
  rig_.Solve(pose);
  EXPECT_EQ(rig_.Value("neck.twist_left"), 0.0f);
  EXPECT_NEAR(rig_.Value("neck.twist_right"), 0.5f, 1e-4f);
}

TEST_P(ClothingDrivers, NoddingIsNoTwist) {
  rig_.Solve(Turned("neck", 35.0f, {1.0f, 0.0f, 0.5f}));
  EXPECT_NEAR(rig_.Value("neck.twist_left"), 0.0f, 1e-5f);
  EXPECT_NEAR(rig_.Value("neck.twist_right"), 0.0f, 1e-5f);
}

TEST_P(ClothingDrivers, TwistSweepIsContinuous) {
  float worst = 0.0f;
  float before = 0.0f;
  for (int i = -1790; i <= 1790; ++i) {
    rig_.Solve(Turned("neck", static_cast<float>(i) * 0.1f, kY));
    const float value = rig_.Value("neck.twist_left") - rig_.Value("neck.twist_right");
    if (i > -1790) worst = std::max(worst, std::abs(value - before));
    before = value;
  }
  std::printf("twist: at most %.6f per 0.1 degree\n", worst);
  EXPECT_LE(worst, 0.1f / 90.0f * 1.01f);
}

TEST_P(ClothingDrivers, AllIsAtRestInTheRestPose) {
  rig_.Solve(RestPose(rig_.skeleton()));
  for (std::size_t i = 0; i < rig_.values().size(); ++i) {
    const std::string& name = rig_.binding()->driver_value_names()[i];
    EXPECT_NEAR(rig_.values()[i], name == "knee_l.extended" ? 1.0f : 0.0f, 1e-6f) << name;
  }
}

TEST(BlendShapes, RunFromNeutralToFull) {
  const auto value = [](float coefficient, float neutral, float full) {
    Rig rig;
    rig.drivers.resize(1);
    rig.drivers[0].name = "shape";
    rig.drivers[0].kind = Driver::Kind::kBlendShape;
    rig.drivers[0].blend_shape = {.blend_shape = "shape", .neutral = neutral, .full = full};
    BoundRig bound(rig, Skeleton(), {"shape"});
    LocalPose pose;
    pose.blend_shapes = {coefficient};
    return bound.ValueAt(pose, "shape.value");
  };
  EXPECT_FLOAT_EQ(value(0.5f, 0.2f, 0.8f), 0.5f);
  EXPECT_EQ(value(0.1f, 0.2f, 0.8f), 0.0f);
  EXPECT_EQ(value(3.0f, 0.2f, 0.8f), 1.0f);
  EXPECT_FLOAT_EQ(value(-0.25f, 0.0f, -1.0f), 0.25f);  // a coefficient that falls
}

}  // namespace
}  // namespace furrow::wrinkle
