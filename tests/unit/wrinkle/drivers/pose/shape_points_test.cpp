// SPDX-License-Identifier: Apache-2.0
// Pose drivers that measure coefficients of blend shapes, alone and beside joints.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/wrinkle/bound_rig.h"
#include "wrinkle/drivers/pose/pose_driver.h"
#include "wrinkle/rig/rig_joints.h"
#include "wrinkle/skeleton/retarget.h"

namespace furrow::wrinkle {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<std::string> kNames = {"browDownLeft", "browInnerUp", "cheekSquintLeft",
                                         "mouthSmileLeft", "noseSneerLeft"};

ControlPoint ShapePoint(const std::string& name) {
  return {.joint = "", .kind = ControlPoint::Kind::kBlendShape, .blend_shape = name};
}

using Poses = std::vector<std::pair<std::string, std::vector<ShapeValue>>>;

// Driver "d" measures the given blend shapes. It has a value for each pose.
Rig ShapeRig(const std::vector<std::string>& shapes, const Poses& poses,
             PoseSolve solve = PoseSolve::kProjection) {
  Rig rig;
  rig.anchor = "head";
  Driver driver;
  driver.name = "d";
  driver.pose.solve = solve;
  for (const std::string& shape : shapes) driver.pose.points.push_back(ShapePoint(shape));
  for (const auto& [name, values] : poses) {
    rig.reference_poses.push_back({.name = name, .shapes = values});
    driver.pose.values.push_back({name, name});
  }
  rig.drivers = {driver};
  return rig;
}

// A pose of the joints at rest, with coefficients in the order of kNames.
LocalPose Coefficients(const Skeleton& skeleton, std::vector<float> coefficients) {
  LocalPose pose = RestPose(skeleton);
  pose.blend_shapes = std::move(coefficients);
  return pose;
}

TEST(ShapePoints, ProjectOntoTheCoefficientsOfThePose) {
  const Rig rig = ShapeRig({"browDownLeft", "noseSneerLeft"},
                           {{"frown", {{"BROWdownleft", 0.8f}, {"noseSneerLeft", 0.6f}}}});
  const Skeleton body = MakeBody();
  BoundRig bound(rig, body, kNames);
  EXPECT_TRUE(bound.binding()->warnings().empty());
  const auto value = [&](float brow, float nose, float smile = 0.0f) {
    return bound.ValueAt(Coefficients(body, {brow, 0, 0, smile, nose}), "d.frown");
  };
  EXPECT_EQ(value(0.0f, 0.0f), 0.0f);
  EXPECT_NEAR(value(0.8f, 0.6f), 1.0f, 1e-6f);
  EXPECT_NEAR(value(0.4f, 0.3f), 0.5f, 1e-6f);
  // dot(x, d) / dot(d, d), with |d| = 1.
  EXPECT_NEAR(value(0.5f, 0.0f), 0.4f, 1e-6f);
  EXPECT_NEAR(value(0.0f, 0.5f), 0.3f, 1e-6f);
  EXPECT_NEAR(value(0.4f, 0.3f, 1.0f), 0.5f, 1e-6f) << "shapes without a point do not count";
  EXPECT_EQ(value(1.0f, 1.0f), 1.0f);
  EXPECT_EQ(value(-0.5f, 0.0f), 0.0f);
}

// Ratios of coefficients have no unit, so neither the skeleton nor its size matters.
TEST(ShapePoints, NeedNoSkeleton) {
  const Rig rig = ShapeRig({"browDownLeft", "mouthSmileLeft"},
                           {{"p", {{"browDownLeft", 0.5f}, {"mouthSmileLeft", -0.25f}}}});
  for (const Skeleton& skeleton : {Skeleton(), MakeBody(0, 1000.0f), MakeBody(3, 1e-3f)}) {
    BoundRig bound(rig, skeleton, kNames);
    EXPECT_NEAR(bound.ValueAt(Coefficients(skeleton, {0.5f, 0, 0, -0.25f, 0}), "d.p"), 1.0f, 1e-6f);
    EXPECT_NEAR(bound.ValueAt(Coefficients(skeleton, {0.5f, 0, 0, 0, 0}), "d.p"), 0.8f, 1e-6f);
    EXPECT_EQ(bound.ValueAt(Coefficients(skeleton, {0, 0, 0, 0, 0}), "d.p"), 0.0f);
  }
}

// A captured pose has the joints of its performer. A phone's recording has none of them.
TEST(ShapePoints, NeedNoneOfTheJointsOfTheirPoses) {
  Rig rig = ShapeRig({"browDownLeft"}, {{"p", {{"browDownLeft", 0.5f}}}});
  rig.anchor.clear();
  rig.reference_poses[0].joints = {{"spine", {0, 0, 1, 0}}};
  EXPECT_EQ(WarningOfModelSpace(rig), "");
  BoundRig bound(rig, Skeleton(), kNames);
  EXPECT_THAT(bound.binding()->warnings(), testing::ElementsAre());
  EXPECT_NEAR(bound.ValueAt(Coefficients(Skeleton(), {0.5f, 0, 0, 0, 0}), "d.p"), 1.0f, 1e-6f);
}

// Three coefficients share a vector: every number of them is laid out right.
TEST(ShapePoints, AnyNumberGivesOneInThePose) {
  const Skeleton body = MakeBody();
  for (std::size_t count = 1; count <= kNames.size(); ++count) {
    std::vector<std::string> shapes(kNames.begin(), kNames.begin() + static_cast<int>(count));
    std::vector<ShapeValue> values;
    std::vector<float> coefficients(kNames.size(), 0.0f);
    for (std::size_t i = 0; i < count; ++i) {
      coefficients[i] = 0.3f + 0.1f * static_cast<float>(i);
      values.push_back({kNames[i], coefficients[i]});
    }
    BoundRig bound(ShapeRig(shapes, {{"p", values}}), body, kNames);
    EXPECT_NEAR(bound.ValueAt(Coefficients(body, coefficients), "d.p"), 1.0f, 1e-6f) << count;
    // Without the last one: 1 - c^2 / |d|^2.
    const float last = coefficients[count - 1];
    float square = 0.0f;
    for (const float c : coefficients) square += c * c;
    coefficients[count - 1] = 0.0f;
    EXPECT_NEAR(bound.ValueAt(Coefficients(body, coefficients), "d.p"), 1.0f - last * last / square,
                1e-6f)
        << count;
  }
}

TEST(ShapePoints, NnlsSeparatesPosesWithCommonShapes) {
  const Poses poses = {
      {"smile", {{"mouthSmileLeft", 1.0f}, {"cheekSquintLeft", 0.5f}}},
      {"squint", {{"cheekSquintLeft", 0.8f}, {"browDownLeft", 0.4f}}},
      {"sneer", {{"noseSneerLeft", 1.0f}, {"browDownLeft", 0.3f}, {"cheekSquintLeft", 0.3f}}}};
  const std::vector<std::vector<float>> coefficients = {
      {0, 0, 0.5f, 1, 0}, {0.4f, 0, 0.8f, 0, 0}, {0.3f, 0, 0.3f, 0, 1}};
  const Skeleton body = MakeBody();
  BoundRig projected(ShapeRig(kNames, poses), body, kNames);
  EXPECT_GT(projected.ValueAt(Coefficients(body, coefficients[0]), "d.squint"), 0.4f);
  BoundRig bound(ShapeRig(kNames, poses, PoseSolve::kNnls), body, kNames);
  bound.Solve(Coefficients(body, std::vector<float>(5, 0.0f)));
  EXPECT_THAT(bound.values(), ElementsAre(0.0f, 0.0f, 0.0f));
  for (std::size_t k = 0; k < 3; ++k) {
    bound.Solve(Coefficients(body, coefficients[k]));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(bound.values()[i], i == k ? 1.0f : 0.0f, 1e-5f) << k << " " << i;
    }
  }
  std::vector<float> mix(5);
  for (std::size_t i = 0; i < 5; ++i) {
    mix[i] = 0.5f * coefficients[0][i] + 0.2f * coefficients[1][i] + 0.3f * coefficients[2][i];
  }
  bound.Solve(Coefficients(body, mix));
  EXPECT_NEAR(bound.values()[0], 0.5f, 1e-5f);
  EXPECT_NEAR(bound.values()[1], 0.2f, 1e-5f);
  EXPECT_NEAR(bound.values()[2], 0.3f, 1e-5f);
}

TEST(ShapePoints, FalloffMeasuresTheOtherShapes) {
  Rig rig = ShapeRig({"browDownLeft", "mouthSmileLeft"}, {{"p", {{"browDownLeft", 1.0f}}}});
  rig.drivers[0].pose.falloff = 0.5f;
  const Skeleton body = MakeBody();
  for (const PoseSolve solve : {PoseSolve::kProjection, PoseSolve::kNnls}) {
    rig.drivers[0].pose.solve = solve;
    BoundRig bound(rig, body, kNames);
    EXPECT_NEAR(bound.ValueAt(Coefficients(body, {0.5f, 0, 0, 0, 0}), "d.p"), 0.5f, 1e-5f);
    // exp(-0.5^2 / (2 * 0.5^2)).
    EXPECT_NEAR(bound.ValueAt(Coefficients(body, {0.5f, 0, 0, 0.5f, 0}), "d.p"),
                0.5f * std::exp(-0.5f), 1e-5f);
  }
}

// A joint that moves by its largest displacement counts as much as a coefficient of 1, on any size.
TEST(ShapePoints, WeighJointsAndShapesAlike) {
  Rig rig = ShapeRig({"mouthSmileLeft"}, {{"p", {{"mouthSmileLeft", 1.0f}}}});
  const Skeleton made = MakeBody();
  rig.reference_poses[0].source_size = SkeletonSize(made);
  rig.reference_poses[0].joints = {
      {.joint = "cheek_l", .rotation = {1, 0, 0, 0}, .translation = {0, 0.02f, 0}}};
  rig.drivers[0].pose.points.push_back({.joint = "cheek_l", .kind = ControlPoint::Kind::kOrigin});
  for (const float size : {1.0f, 100.0f}) {
    const Skeleton body = MakeBody(7, size);
    BoundRig bound(rig, body, kNames);
    const auto value = [&](float smile, float move) {
      LocalPose pose = Coefficients(body, {0, 0, 0, smile, 0});
      Move(body, "cheek_l", {0, size * move, 0}, &pose);
      return bound.ValueAt(pose, "d.p");
    };
    EXPECT_NEAR(value(0.0f, 0.0f), 0.0f, 1e-6f);
    EXPECT_NEAR(value(1.0f, 0.02f), 1.0f, 1e-4f);
    EXPECT_NEAR(value(1.0f, 0.0f), 0.5f, 1e-4f);
    EXPECT_NEAR(value(0.0f, 0.02f), 0.5f, 1e-4f);
    EXPECT_NEAR(value(0.5f, 0.01f), 0.5f, 1e-4f);
  }
}

class StreamsThatLackSomething : public testing::Test {
 protected:
  StreamsThatLackSomething() {
    rig_.reference_poses[0].joints = {
        {.joint = "cheek_l", .rotation = {1, 0, 0, 0}, .translation = {0, 0.02f, 0}}};
  }
  void MeasureTheCheek() {
    rig_.drivers[0].pose.points.push_back(
        {.joint = "cheek_l", .kind = ControlPoint::Kind::kOrigin});
  }
  RigBinding Bind(const Skeleton& skeleton, const std::vector<std::string>& names) {
    auto binding = RigBinding::Create(rig_, skeleton, names, {.allow_missing = true});
    EXPECT_TRUE(binding.ok()) << binding.status().ToString();
    return *std::move(binding);
  }
  static float Value(RigBinding binding, const LocalPose& pose) {
    SubjectSolver solver(std::make_shared<const RigBinding>(std::move(binding)), false);
    EXPECT_EQ(solver.Update(pose, 0.0), JobStatus::kOk);
    return solver.driver_values()[0];
  }
  LocalPose Posed(std::vector<float> coefficients) const {
    LocalPose pose = Coefficients(body_, std::move(coefficients));
    Move(body_, "cheek_l", {0, 0.02f, 0}, &pose);
    return pose;
  }

  Skeleton body_ = MakeBody();
  Rig rig_ = ShapeRig({"browDownLeft", "mouthSmileLeft"},
                      {{"p", {{"browDownLeft", 1.0f}, {"mouthSmileLeft", 0.5f}}}});
};

TEST_F(StreamsThatLackSomething, LeaveOutTheShape) {
  RigBinding binding = Bind(Skeleton(), {"mouthSmileLeft"});
  EXPECT_THAT(binding.missing_blend_shapes(), ElementsAre("browDownLeft"));
  EXPECT_NEAR(Value(std::move(binding), Coefficients(Skeleton(), {0.5f})), 1.0f, 1e-6f);
  EXPECT_EQ(Value(Bind(Skeleton(), {"tongueOut"}), Coefficients(Skeleton(), {1.0f})), 0.0f);
  EXPECT_EQ(Value(Bind(body_, {}), RestPose(body_)), 0.0f);
}

TEST_F(StreamsThatLackSomething, MeasureJointsAloneOrShapesAlone) {
  MeasureTheCheek();
  EXPECT_NEAR(Value(Bind(body_, {}), Posed({})), 1.0f, 1e-5f) << "no blend shapes";
  RigBinding shapes = Bind(Skeleton(), kNames);
  EXPECT_THAT(shapes.missing_joints(), ElementsAre("head", "cheek_l"));
  const LocalPose pose = Coefficients(Skeleton(), {1.0f, 0, 0, 0.5f, 0});
  EXPECT_NEAR(Value(std::move(shapes), pose), 1.0f, 1e-6f) << "no joints";
  EXPECT_NEAR(Value(Bind(body_, kNames), Posed({1.0f, 0, 0, 0.5f, 0})), 1.0f, 1e-5f);
}

TEST_F(StreamsThatLackSomething, AreRefusedByStrictBinding) {
  const auto binding = RigBinding::Create(rig_, body_, std::vector<std::string>{"tongueOut"});
  EXPECT_EQ(binding.status().code(), StatusCode::kNotFound);
  EXPECT_THAT(binding.status().what(), HasSubstr("'browDownLeft'"));
}

TEST(ShapePoints, APoseThatMovesNoneOfThemIsReported) {
  const Rig rig = ShapeRig({"browDownLeft"},
                           {{"p", {{"mouthSmileLeft", 1.0f}}}, {"q", {{"browDownLeft", 1e-5f}}}});
  const BoundRig bound(rig, Skeleton(), kNames);
  ASSERT_EQ(bound.binding()->warnings().size(), 2u);
  EXPECT_THAT(bound.binding()->warnings()[0], HasSubstr("'p' does not move its control points"));
}

}  // namespace
}  // namespace furrow::wrinkle
