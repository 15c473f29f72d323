// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/solver/explain.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/wrinkle/bound_rig.h"

namespace furrow::wrinkle {
namespace {

class ExplainTest : public testing::Test {
 protected:
  ExplainTest() {
    Turn(rig_.skeleton(), "brow_l", AngleAxis(-25.0f, {1, 0, 0}), &pose_);
    Turn(rig_.skeleton(), "brow_r", AngleAxis(14.0f, {0.8f, -0.6f, 0.0f}), &pose_);
    Turn(rig_.skeleton(), "shin_l", AngleAxis(-20.0f, {1, 0, 0}), &pose_);
    Turn(rig_.skeleton(), "thigh_l", AngleAxis(40.0f, {0, 0, 1}), &pose_);
    Turn(rig_.skeleton(), "neck", AngleAxis(-33.0f, {0, 1, 0}), &pose_);
    rig_.Solve(pose_);
    EXPECT_EQ(Explain(*rig_.binding(), pose_, &explanation_), JobStatus::kOk);
  }
  const Explanation::Weight& Weight(const std::string& name) {
    for (const Explanation::Weight& weight : explanation_.weights) {
      if (weight.name == name) return weight;
    }
    ADD_FAILURE() << name;
    return explanation_.weights.front();
  }
  float Angle(const std::string& driver, const std::string& what) {
    for (const Explanation::Angle& angle : explanation_.angles) {
      if (angle.driver == driver && angle.what == what) return angle.degrees;
    }
    ADD_FAILURE() << driver << " " << what;
    return 0.0f;
  }

  BoundRig rig_{MakeRig(), MakeBody(5)};
  LocalPose pose_ = RestPose(rig_.skeleton());
  Explanation explanation_;
};

TEST_F(ExplainTest, EndsInTheWeightsThatAreSent) {
  ASSERT_EQ(explanation_.weights.size(), rig_.weights().size());
  for (std::size_t i = 0; i < rig_.weights().size(); ++i) {
    EXPECT_EQ(explanation_.weights[i].name, rig_.binding()->weight_names()[i]);
    EXPECT_EQ(explanation_.weights[i].result, rig_.weights()[i]);
  }
}

TEST_F(ExplainTest, ShowsEachStepOfAConflict) {
  const Explanation::Weight& squash = Weight("brow_r.squash");
  ASSERT_EQ(squash.contributions.size(), 1u);
  EXPECT_EQ(squash.contributions[0].driver_value, "brow_r.squash");
  EXPECT_EQ(squash.contributions[0].value, rig_.Value("brow_r.squash"));
  EXPECT_EQ(squash.contributions[0].product, squash.combined);
  EXPECT_NEAR(squash.modulated, 0.5f * (1.0f - std::cos(3.14159265f * squash.combined)), 1e-5f);
  ASSERT_EQ(squash.conflicts.size(), 1u);
  EXPECT_EQ(squash.conflicts[0].weight, "brow_l.stretch");
  EXPECT_NEAR(squash.conflicts[0].other, 1.0f, 1e-5f);
  EXPECT_LT(squash.conflicts[0].factor, 0.5f);
  EXPECT_NEAR(squash.result, squash.modulated * squash.conflicts[0].factor, 1e-6f);
}

TEST_F(ExplainTest, NamesTheModulationAndShowsTheValueBeforeACurve) {
  EXPECT_EQ(Weight("brow_r.squash").modulation, "cosine");
  Rig rig = MakeRig();
  rig.regions[1].feeds[1].curve = {{0.0f, 0.25f}, {1.0f, 0.75f}};  // y = x / 2 + 1 / 4
  const BoundRig bound(rig, MakeBody(5));
  ASSERT_EQ(Explain(*bound.binding(), pose_, &explanation_), JobStatus::kOk);
  const Explanation::Weight& squash = Weight("brow_r.squash");
  EXPECT_EQ(squash.modulation, "curve");
  EXPECT_EQ(squash.contributions[0].product, squash.combined);
  EXPECT_NEAR(squash.modulated, 0.5f * squash.combined + 0.25f, 1e-6f);
  EXPECT_EQ(Weight("brow_r.stretch").modulation, "cosine");
}

TEST_F(ExplainTest, ShowsTheGeometryOfAPoseDriver) {
  const Explanation::PoseValue& stretch = explanation_.pose_values[0];
  EXPECT_EQ(stretch.driver_value, "brow_l.stretch");
  // A tail sqrt(0.01^2 + 0.05^2) from its joint, turned by 25 degrees: a chord of 2 r sin(12.5).
  const float chord = 2.0f * std::sqrt(0.0026f) * std::sin(glm::radians(12.5f));
  EXPECT_NEAR(stretch.displacement, chord, 1e-5f);
  EXPECT_NEAR(stretch.moved, chord, 1e-5f);
  EXPECT_NEAR(stretch.numerator, chord * chord, 1e-6f);
  EXPECT_NEAR(stretch.along, 1.0f, 1e-5f);
  EXPECT_NEAR(stretch.perpendicular, 0.0f, 1e-6f);
  EXPECT_EQ(stretch.falloff, 1.0f);
  EXPECT_NEAR(stretch.result, 1.0f, 1e-5f);
  for (const Explanation::PoseValue& value : explanation_.pose_values) {
    EXPECT_EQ(value.result, rig_.Value(value.driver_value));
  }
}

TEST_F(ExplainTest, ShowsAnglesInDegrees) {
  EXPECT_NEAR(Angle("knee_l", "flexion"), -20.0f, 1e-2f);
  EXPECT_NEAR(Angle("hip_l", "bend"), 40.0f, 1e-2f);
  EXPECT_NEAR(Angle("hip_l", "direction"), -90.0f, 1e-2f);  // to the subject's left
  EXPECT_NEAR(Angle("neck", "twist"), -33.0f, 1e-2f);
}

TEST_F(ExplainTest, ShowsTheStrainOfAPatch) {
  // Its lowest row, 0.02 below the highest, comes up by 0.005: three quarters as high.
  pose_ = RestPose(rig_.skeleton());
  Move(rig_.skeleton(), "cheek_l", {0.0f, 0.005f, 0.0f}, &pose_);
  ASSERT_EQ(Explain(*rig_.binding(), pose_, &explanation_), JobStatus::kOk);
  ASSERT_EQ(explanation_.strains.size(), 1u);
  EXPECT_EQ(explanation_.strains[0].driver, "cheek_patch");
  EXPECT_NEAR(explanation_.strains[0].smallest, 0.75f, 1e-5f);
  EXPECT_NEAR(explanation_.strains[0].largest, 1.0f, 1e-5f);
  EXPECT_NEAR(explanation_.strains[0].degrees, 0.0f, 0.01f);
}

TEST_F(ExplainTest, NamesTheBlendShapesOfEveryKind) {
  Rig rig = MakeRig();
  rig.reference_poses[2].shapes = {{"mouthSmileLeft", 0.8f}};
  for (Driver& driver : rig.drivers) {
    if (driver.name == "cheek_l") {
      driver.pose.points.push_back(
          {.joint = "", .kind = ControlPoint::Kind::kBlendShape, .blend_shape = "mouthSmileLeft"});
    }
    if (driver.name == "cheek_patch") {
      driver.strain.shapes = {{"cheekPuff", {0}, {0, 0, 0.001f}}, {"jawOpen", {1}, {0, 0.001f, 0}}};
    }
  }
  const BoundRig bound(rig, MakeBody(5), {"jawOpen", "mouthSmileLeft", "cheekPuff"});
  pose_.blend_shapes = {0.25f, 0.5f};
  ASSERT_EQ(Explain(*bound.binding(), pose_, &explanation_), JobStatus::kOk);
  std::string text;
  for (const Explanation::Shape& shape : explanation_.shapes) {
    text += shape.driver + " " + shape.blend_shape + " " + std::to_string(shape.coefficient) + "\n";
  }
  EXPECT_EQ(text,
            "cheek_l mouthSmileLeft 0.500000\n"
            "jaw jawOpen 0.250000\n"
            "cheek_patch jawOpen 0.250000\n");
}

TEST_F(ExplainTest, LeavesTheExplanationAloneOnFailure) {
  pose_.joints.pop_back();
  const std::size_t before = explanation_.weights.size();
  EXPECT_EQ(Explain(*rig_.binding(), pose_, &explanation_), JobStatus::kSizeMismatch);
  EXPECT_EQ(explanation_.weights.size(), before);
}

}  // namespace
}  // namespace furrow::wrinkle
