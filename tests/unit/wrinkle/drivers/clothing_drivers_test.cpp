// SPDX-License-Identifier: Apache-2.0
// Hinge, ball, twist and blend-shape drivers on a body, whatever its local frames.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include <glm/gtx/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/unit/wrinkle/bound_rig.h"
#include "wrinkle/drivers/ball/ball_fields.h"
#include "wrinkle/solver/explain.h"

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

// A limb that rests bent by 20 degrees reads 0 at rest if that direction counts as straight, and
// 4.6 of the further bend.
TEST_P(ClothingDrivers, BoneStatesTheStraightDirection) {
  const glm::vec3 knee(0.1f, 0.5f, 0.0f);
  // Right-handed about +x, a hanging bone turns towards -z.
  const auto hanging = [](float degrees) {
    return glm::vec3(0.0f, -std::cos(glm::radians(degrees)), -std::sin(glm::radians(degrees)));
  };
  const Skeleton bent = MakeSkeleton({{"hips", "", {0.1f, 1.4f, 0.0f}, {}},
                                      {"thigh_l", "hips", {0.1f, 0.95f, 0.0f}, {}},
                                      {"shin_l", "thigh_l", knee, knee + 0.4f * hanging(20.0f)}},
                                     GetParam());
  Rig rig;
  Driver driver;
  driver.kind = Driver::Kind::kHinge;
  driver.hinge = {.parent = "thigh_l", .joint = "shin_l", .axis = kX};
  rig.drivers = {driver, driver, driver};
  rig.drivers[0].name = "as_built";
  rig.drivers[1].name = "from_rest";
  rig.drivers[1].hinge.bone = 3.0f * hanging(20.0f);
  rig.drivers[2].name = "without_axis";
  rig.drivers[2].hinge.bone = hanging(20.0f);
  rig.drivers[2].hinge.axis.reset();
  BoundRig bound(rig, bent, {});
  const auto solve = [&](float degrees, float hip_degrees) {
    LocalPose pose = RestPose(bent);
    Turn(bent, "shin_l", AngleAxis(degrees, kX), &pose);
    Turn(bent, "thigh_l", AngleAxis(hip_degrees, {0.4f, 1.0f, -0.2f}), &pose);
    bound.Solve(pose);
  };
  solve(0.0f, 0.0f);
  // (1 - cos 20) / (1 + cos 30)
  EXPECT_NEAR(bound.Value("as_built.flexed"), 0.0323183f, 1e-5f);
  EXPECT_NEAR(bound.Value("from_rest.flexed"), 0.0f, 1e-6f);
  EXPECT_NEAR(bound.Value("from_rest.extended"), 1.0f, 1e-6f);
  EXPECT_NEAR(bound.Value("without_axis.flexed"), 0.0f, 1e-6f);
  for (const float hip : {0.0f, 65.0f}) {  // the direction turns with the thigh
    solve(45.0f, hip);
    EXPECT_NEAR(bound.Value("from_rest.flexed"), 0.1569609f, 1e-5f);
    EXPECT_NEAR(bound.Value("without_axis.flexed"), 0.1569609f, 1e-5f);
    solve(90.0f, hip);
    EXPECT_NEAR(bound.Value("from_rest.flexed"), 0.5358984f, 1e-5f);
    solve(-15.0f, hip);
    EXPECT_NEAR(bound.Value("from_rest.flexed"), 0.0f, 1e-6f);
    // (1 - cos 15) / (1 + cos 30): without an axis, either way counts.
    EXPECT_NEAR(bound.Value("without_axis.flexed"), 0.0182602f, 1e-5f);
  }
  Explanation explanation;
  LocalPose pose = RestPose(bent);
  Turn(bent, "shin_l", AngleAxis(-15.0f, kX), &pose);
  ASSERT_EQ(Explain(*bound.binding(), pose, &explanation), JobStatus::kOk);
  ASSERT_EQ(explanation.angles.size(), 3u);
  EXPECT_NEAR(explanation.angles[0].degrees, 5.0f, 1e-2f);
  EXPECT_NEAR(explanation.angles[1].degrees, -15.0f, 1e-2f);
  EXPECT_NEAR(explanation.angles[2].degrees, 15.0f, 1e-2f);
}

// With a stated direction, the upper bone needs no length: the joint may lie on its parent.
TEST_P(ClothingDrivers, BoneServesWhereTheUpperBoneHasNoLength) {
  const Skeleton skeleton = MakeSkeleton(
      {{"root", "", {0, 1, 0}, {}}, {"arm", "root", {0, 1, 0}, glm::vec3(0, 0, 0)}}, GetParam());
  Rig rig;
  rig.drivers.resize(1);
  rig.drivers[0].name = "arm";
  rig.drivers[0].kind = Driver::Kind::kHinge;
  rig.drivers[0].hinge = {.parent = "root", .joint = "arm", .axis = kX};
  EXPECT_EQ(RigBinding::Create(rig, skeleton, {}).status().code(), StatusCode::kInvalidArgument);
  rig.drivers[0].hinge.bone = -kY;
  BoundRig bound(rig, skeleton, {});
  LocalPose pose = RestPose(skeleton);
  Turn(skeleton, "arm", AngleAxis(90.0f, kX), &pose);
  EXPECT_NEAR(bound.ValueAt(pose, "arm.flexed"), 0.5358984f, 1e-5f);
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

TEST_P(ClothingDrivers, EachSideOfABallHasItsOwnRange) {
  Rig own = MakeRig();
  for (Driver& driver : own.drivers) {
    if (driver.name == "hip_l") driver.ball.back = {.threshold_degrees = 10, .limit_degrees = 60};
  }
  BoundRig rig(own, MakeBody(GetParam()));
  const auto at = [&](float degrees, const std::string& value) {
    rig.Solve(Turned("thigh_l", degrees, kX));  // a positive turn carries the leg back
    return rig.Value("hip_l." + value);
  };
  EXPECT_EQ(at(9.0f, "back"), 0.0f);
  EXPECT_NEAR(at(35.0f, "back"), 0.3416938f, 1e-4f);  // (cos 10 - cos 35) / (cos 10 - cos 60)
  EXPECT_NEAR(at(60.0f, "back"), 1.0f, 1e-4f);
  EXPECT_NEAR(at(80.0f, "back"), 1.0f, 1e-5f);
  EXPECT_NEAR(at(-90.0f, "front"), 0.5358984f, 1e-4f);  // as before
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

// An arm that rests in a T-pose and hangs down when straight, as in the shipped rigs.
class Shoulder : public testing::TestWithParam<unsigned> {
 protected:
  static Rig ShoulderRig(BallMode mode) {
    Rig rig;
    rig.drivers.resize(1);
    Driver& driver = rig.drivers[0];
    driver.name = "shoulder_l";
    driver.kind = Driver::Kind::kBall;
    driver.ball = {.parent = "spine",
                   .joint = "upper_arm_l",
                   .end = "forearm_l",
                   .bone = {0.0f, -1.0f, 0.0f},
                   .mode = mode};
    return rig;
  }
  struct Shares {
    float front, back, left, right;
    [[nodiscard]] float Sum() const { return front + back + left + right; }
    [[nodiscard]] float Change(const Shares& other) const {
      return std::max({std::abs(front - other.front), std::abs(back - other.back),
                       std::abs(left - other.left), std::abs(right - other.right)});
    }
  };
  // The arm points along `direction` (model axes).
  static Shares Pointing(BoundRig* rig, const glm::vec3& direction) {
    LocalPose pose = RestPose(rig->skeleton());
    Turn(rig->skeleton(), "upper_arm_l", glm::rotation(kX, glm::normalize(direction)), &pose);
    rig->Solve(pose);
    return {rig->Value("shoulder_l.front"), rig->Value("shoulder_l.back"),
            rig->Value("shoulder_l.left"), rig->Value("shoulder_l.right")};
  }
  Shares Pointing(const glm::vec3& direction) { return Pointing(&rig_, direction); }
  // From hanging (0 degrees) towards the side that `psi` gives, from the front to the right.
  static glm::vec3 Raised(float degrees, float psi) {
    const float a = glm::radians(degrees);
    const float b = glm::radians(psi);
    return {-std::sin(a) * std::sin(b), -std::cos(a), std::sin(a) * std::cos(b)};
  }
  static float Bend(float degrees) {
    return std::min(1.0f, (1.0f - std::cos(glm::radians(degrees))) / 1.8660254f);
  }

  BoundRig rig_{ShoulderRig(BallMode::kSmooth), MakeBody(GetParam())};
};

INSTANTIATE_TEST_SUITE_P(LocalFrames, Shoulder, testing::Values(0u, 31u));

// Great circles over the whole sphere, through the straight direction and its opposite, around
// them, and at random.
TEST_P(Shoulder, AnySweepIsContinuous) {
  std::mt19937 random(5);
  float worst = 0.0f;
  for (int circle = 0; circle < 150; ++circle) {
    const glm::vec3 axis = circle < 40 ? Raised(90.0f, static_cast<float>(circle) * 4.5f)
                                       : glm::normalize(RandomVector(&random, 1.0f));
    const glm::vec3 across = circle < 40 ? -kY : glm::normalize(glm::cross(axis, kX + 0.1f * kY));
    const glm::vec3 other = glm::cross(axis, across);
    Shares before = Pointing(across);
    for (int i = 1; i <= 3600; ++i) {
      const float a = glm::radians(static_cast<float>(i) * 0.1f);
      const Shares now = Pointing(std::cos(a) * across + std::sin(a) * other);
      worst = std::max(worst, now.Change(before));
      before = now;
    }
  }
  std::printf("ball, over the sphere: at most %.6f per 0.1 degree\n", worst);
  EXPECT_LE(worst, 0.02f);
}

// The joint's own range: all directions but 45 degrees around the singular one, which lies behind
// the head on the other side. There the values are as steady as those of the formula's other parts.
TEST_P(Shoulder, JitterOverheadMovesNoFold) {
  for (float psi = 0.0f; psi < 360.0f; psi += 10.0f) {
    for (const float degrees : {175.0f, 179.0f, 179.9f}) {
      const Shares up = Pointing(Raised(degrees, psi));
      EXPECT_LE(Pointing(Raised(degrees, psi + 180.0f)).Change(up), 0.1f) << psi;
      EXPECT_LE(Pointing(Raised(degrees - 1.0f, psi)).Change(up), 0.02f) << psi;
      EXPECT_NEAR(up.Sum(), 1.0f, 1e-5f);
      EXPECT_GT(up.left, 0.9f) << "overhead counts as raised to the side of the rest pose";
    }
  }
}

// Up to 120 degrees the shares are those of the direction around the straight arm.
TEST_P(Shoulder, DirectionsUpTo120DegreesAreThoseAroundTheStraightArm) {
  for (const float degrees : {0.01f, 1.0f, 20.0f, 60.0f, 90.0f, 119.9f}) {
    for (float psi = 0.0f; psi < 360.0f; psi += 7.5f) {
      const Shares shares = Pointing(Raised(degrees, psi));
      const float bend = Bend(degrees);
      const float cosine = std::cos(glm::radians(psi));
      const float sine = std::sin(glm::radians(psi));
      const auto part = [bend](float x) { return bend * std::max(x, 0.0f) * std::max(x, 0.0f); };
      EXPECT_NEAR(shares.front, part(cosine), 2e-5f) << degrees << " " << psi;
      EXPECT_NEAR(shares.back, part(-cosine), 2e-5f) << degrees << " " << psi;
      EXPECT_NEAR(shares.right, part(sine), 2e-5f) << degrees << " " << psi;
      EXPECT_NEAR(shares.left, part(-sine), 2e-5f) << degrees << " " << psi;
    }
  }
}

// The values fade around one direction only: 141 degrees from straight, opposite the rest pose.
TEST_P(Shoulder, SharesSumToTheBendExceptAroundOneDirection) {
  const glm::vec3 singular = Raised(141.1f, 90.0f);
  EXPECT_LT(Pointing(singular).Sum(), 0.01f);
  for (float degrees = 0.0f; degrees <= 180.0f; degrees += 3.0f) {
    for (float psi = 0.0f; psi < 360.0f; psi += 5.0f) {
      const glm::vec3 direction = Raised(degrees, psi);
      const float sum = Pointing(direction).Sum();
      EXPECT_LE(sum, Bend(degrees) + 1e-5f);
      if (glm::dot(direction, singular) > std::cos(glm::radians(35.0f))) continue;
      EXPECT_NEAR(sum, Bend(degrees), 2e-5f) << degrees << " " << psi;
    }
  }
}

// The printed rule stays as it is, with its jumps.
TEST_P(Shoulder, ThesisModeDoesNotTurn) {
  BoundRig rig(ShoulderRig(BallMode::kThesis), MakeBody(GetParam()));
  for (const float degrees : {60.0f, 170.0f, 179.0f}) {
    EXPECT_NEAR(Pointing(&rig, Raised(degrees, 40.0f)).front, Bend(degrees), 1e-5f);
    EXPECT_NEAR(Pointing(&rig, Raised(degrees, 43.0f)).right, Bend(degrees), 1e-5f);
    EXPECT_NEAR(Pointing(&rig, Raised(degrees, -43.0f)).left, Bend(degrees), 1e-5f);
  }
}

// However far an arm droops in its rest pose, the same motion raises the same value.
TEST(SubjectsRight, StaysWhereItIsWhileAnArmDroops) {
  for (const float side : {1.0f, -1.0f}) {
    glm::vec3 before(0.0f);
    for (float droop = 90.0f; droop >= -40.0f; droop -= 1.0f) {
      const float a = glm::radians(droop);
      const glm::vec3 bone(side * std::cos(a), -std::sin(a), 0.0f);
      const glm::vec3 right = SubjectsRight(bone, kZ);
      EXPECT_NEAR(glm::dot(right, bone), 0.0f, 1e-6f);
      if (droop < 90.0f) {
        EXPECT_GT(glm::dot(right, before), 0.999f) << droop;
      }
      before = right;
    }
    // An arm that hangs has its right on the subject's right.
    EXPECT_NEAR(SubjectsRight(-kY, kZ).x, -1.0f, 1e-6f);
  }
  EXPECT_NEAR(SubjectsRight(kX, kZ).y, -1.0f, 1e-6f);
  EXPECT_NEAR(SubjectsRight(-kX, kZ).y, 1.0f, 1e-6f);
  EXPECT_NEAR(SubjectsRight(kY, kZ).x, -1.0f, 1e-6f);  // a spine
}

TEST(Ball, AnArmThatRestsLowKeepsItsSides) {
  for (const float droop : {0.0f, 3.0f, 5.0f, 6.0f, 7.0f, 20.0f, 45.0f, 80.0f}) {
    const float a = glm::radians(droop);
    const glm::vec3 bone(std::cos(a), -std::sin(a), 0.0f);
    const glm::vec3 shoulder(0.15f, 1.4f, 0.0f);
    const Skeleton body = MakeSkeleton({{"spine", "", {0, 1, 0}, {}},
                                        {"arm", "spine", shoulder, {}},
                                        {"forearm", "arm", shoulder + 0.25f * bone, {}},
                                        {"hand", "forearm", shoulder + 0.5f * bone, glm::vec3(0)}});
    Rig rig;
    rig.drivers.resize(1);
    rig.drivers[0].name = "shoulder";
    rig.drivers[0].kind = Driver::Kind::kBall;
    rig.drivers[0].ball = {.parent = "spine", .joint = "arm", .end = "forearm", .bone = bone};
    BoundRig bound(rig, body);
    LocalPose pose = RestPose(body);
    Turn(body, "arm", AngleAxis(40.0f, kZ), &pose);  // raises a left arm
    bound.Solve(pose);
    EXPECT_GT(bound.Value("shoulder.left"), 0.1f) << droop;
    EXPECT_NEAR(bound.Value("shoulder.right"), 0.0f, 1e-6f) << droop;
  }
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
