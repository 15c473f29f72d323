// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/solver/subject_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/allocation_counter.h"
#include "tests/unit/wrinkle/bound_rig.h"
#include "wrinkle/skeleton/retarget.h"

namespace furrow::wrinkle {
namespace {

// An expression with every driver away from rest.
LocalPose Expressive(const Skeleton& skeleton) {
  LocalPose pose = RestPose(skeleton);
  Turn(skeleton, "brow_l", AngleAxis(-12.0f, {1, 0, 0}), &pose);
  Turn(skeleton, "brow_r", AngleAxis(10.0f, {0.8f, -0.6f, 0.0f}), &pose);
  Move(skeleton, "cheek_l", {0.003f, 0.015f, 0.002f}, &pose);
  Turn(skeleton, "shin_l", AngleAxis(70.0f, {1, 0, 0}), &pose);
  Turn(skeleton, "thigh_l", AngleAxis(-50.0f, {1, 0, 0.4f}), &pose);
  Turn(skeleton, "spine", AngleAxis(25.0f, {1, 0, -1}), &pose);
  Turn(skeleton, "neck", AngleAxis(30.0f, {0.1f, 1, 0}), &pose);
  pose.blend_shapes = {0.6f};
  return pose;
}

TEST(Solver, RigidMotionOfTheWholeCharacterChangesNothing) {
  std::mt19937 random(14);
  for (const unsigned frames : {0u, 5u}) {
    BoundRig rig(MakeRig(), MakeBody(frames));
    LocalPose pose = Expressive(rig.skeleton());
    rig.Solve(pose);
    const std::vector<float> values = rig.values();
    const std::vector<float> weights = rig.weights();
    for (int round = 0; round < 100; ++round) {
      const glm::quat turn = RandomRotation(&random);
      LocalPose moved = pose;
      moved.joints[0].rotation = turn * pose.joints[0].rotation;
      moved.joints[0].translation =
          turn * pose.joints[0].translation + RandomVector(&random, 500.0f);
      rig.Solve(moved);
      for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(rig.values()[i], values[i], 1e-5f);
      for (std::size_t i = 0; i < weights.size(); ++i)
        EXPECT_NEAR(rig.weights()[i], weights[i], 1e-5f);
    }
  }
}

TEST(Solver, NoddingMakesNoFacialWrinkles) {
  std::mt19937 random(15);
  BoundRig rig(MakeRig(), MakeBody(5));
  LocalPose pose = Expressive(rig.skeleton());
  rig.Solve(pose);
  const std::vector<float> before = rig.weights();
  for (int round = 0; round < 50; ++round) {
    Turn(rig.skeleton(), "head", RandomRotation(&random), &pose);
    rig.Solve(pose);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(rig.weights()[i], before[i], 1e-5f);
  }
}

// The same pose of a larger character gives the same values.
TEST(Solver, ScaleOfTheWholeCharacterChangesNothing) {
  BoundRig rig(MakeRig(), MakeBody(5));
  LocalPose pose = Expressive(rig.skeleton());
  rig.Solve(pose);
  const std::vector<float> before = rig.values();
  pose.joints[0].scale = glm::vec3(3.0f);
  rig.Solve(pose);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(rig.values()[i], before[i], 1e-5f);
}

TEST(Solver, NeutralIsZeroAndTheReferencePoseIsOne) {
  BoundRig rig(MakeRig(), MakeBody(5));
  rig.Solve(RestPose(rig.skeleton()));
  for (const char* name : {"brow_l.stretch", "brow_l.squash", "brow_r.stretch", "cheek_l.squash"}) {
    EXPECT_NEAR(rig.Weight(name), 0.0f, 1e-6f) << name;
  }
  LocalPose pose = RestPose(rig.skeleton());
  Turn(rig.skeleton(), "brow_l", AngleAxis(-25.0f, {1, 0, 0}), &pose);
  Turn(rig.skeleton(), "brow_r", AngleAxis(-25.0f, {1, 0, 0}), &pose);
  rig.Solve(pose);
  EXPECT_NEAR(rig.Value("brow_l.stretch"), 1.0f, 1e-5f);
  EXPECT_NEAR(rig.Weight("brow_l.stretch"), 1.0f, 1e-5f);
  EXPECT_NEAR(rig.Value("brow_r.stretch"), 1.0f, 1e-5f);
}

TEST(Solver, EverythingStaysInRangeOnRandomPoses) {
  std::mt19937 random(16);
  for (const BallMode mode : {BallMode::kSmooth, BallMode::kThesis}) {
    for (const PoseSolve solve : {PoseSolve::kProjection, PoseSolve::kNnls}) {
      Rig test_rig = MakeRig();
      for (Driver& driver : test_rig.drivers) {
        driver.ball.mode = mode;
        driver.pose.solve = solve;
      }
      test_rig.regions[0].combine = Combine::kSum;
      test_rig.regions[0].feeds[0].sources.push_back({"brow_r", "stretch", 5.0f});
      test_rig.regions[1].modulation = Modulation::kCubic;
      BoundRig rig(test_rig, MakeBody(5));
      LocalPose pose;
      for (int round = 0; round < 500; ++round) {
        RandomPose(rig.skeleton(), &random, &pose);
        rig.Solve(pose);
        for (const float value : rig.values()) EXPECT_TRUE(value >= 0.0f && value <= 1.0f) << value;
        for (const float weight : rig.weights()) EXPECT_TRUE(weight >= 0.0f && weight <= 1.0f);
      }
    }
  }
}

TEST(Solver, SurvivesDegeneratePoses) {
  BoundRig rig(MakeRig(), MakeBody(5));
  LocalPose pose = RestPose(rig.skeleton());
  for (Transform& joint : pose.joints) {
    joint.scale = glm::vec3(0.0f);
    joint.translation = glm::vec3(0.0f);
  }
  rig.Solve(pose);
  for (const float value : rig.values()) EXPECT_TRUE(value >= 0.0f && value <= 1.0f) << value;
  for (Transform& joint : pose.joints) {
    joint.scale = glm::vec3(1e30f);
    joint.translation = glm::vec3(3e38f);
  }
  rig.Solve(pose);
  for (const float value : rig.values()) EXPECT_TRUE(value >= 0.0f && value <= 1.0f) << value;
}

TEST(SubjectSolver, ValidatesOneInputAtATime) {
  BoundRig rig(MakeRig(), MakeBody());
  LocalPose pose = Expressive(rig.skeleton());
  SubjectSolver solver(rig.binding());
  EXPECT_EQ(solver.Update(pose, 0.0), JobStatus::kOk);
  LocalPose broken = pose;
  broken.joints.pop_back();
  EXPECT_EQ(solver.Update(broken, 0.0), JobStatus::kSizeMismatch);
  broken = pose;
  broken.blend_shapes.clear();
  EXPECT_EQ(solver.Update(broken, 0.0), JobStatus::kOk);
  broken.blend_shapes = {std::numeric_limits<float>::infinity()};
  EXPECT_EQ(solver.Update(broken, 0.0), JobStatus::kNonFinite);
  broken = pose;
  broken.joints[2].scale.x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(solver.Update(broken, 0.0), JobStatus::kNonFinite);
}

TEST(JointInfluenceJob, ValidatesOneInputAtATime) {
  BoundRig rig(MakeRig(), MakeBody());
  std::vector<float> influences(static_cast<std::size_t>(rig.skeleton().num_joints()) *
                                rig.binding()->dynamic_masks().size());
  const JointInfluenceJob job{
      .binding = rig.binding().get(), .driver_values = rig.values(), .influences = influences};
  EXPECT_EQ(job.Validate(), JobStatus::kOk);
  JointInfluenceJob broken = job;
  broken.binding = nullptr;
  EXPECT_EQ(broken.Validate(), JobStatus::kNullPointer);
  broken = job;
  broken.driver_values = broken.driver_values.first(broken.driver_values.size() - 1);
  EXPECT_EQ(broken.Validate(), JobStatus::kSizeMismatch);
  broken = job;
  broken.influences = broken.influences.first(broken.influences.size() - 1);
  EXPECT_EQ(broken.Validate(), JobStatus::kSizeMismatch);
  for (const float value :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    rig.values()[3] = value;
    EXPECT_EQ(job.Run(), JobStatus::kNonFinite);
  }
}

TEST(SubjectSolver, WithoutFilterEachPoseStandsAlone) {
  BoundRig rig(MakeRig(), MakeBody(5));
  const LocalPose pose = Expressive(rig.skeleton());
  rig.Solve(pose);
  SubjectSolver solver(rig.binding(), false);
  ASSERT_EQ(solver.Update(RestPose(rig.skeleton()), 0.0), JobStatus::kOk);
  ASSERT_EQ(solver.Update(pose, 1.0 / 60.0), JobStatus::kOk);
  for (std::size_t i = 0; i < rig.weights().size(); ++i) {
    EXPECT_EQ(solver.wrinkle_weights()[i], rig.weights()[i]);
  }
}

TEST(SubjectSolver, FiltersTowardsThePoseAndDecaysToNeutral) {
  BoundRig rig(MakeRig(), MakeBody(5));
  const LocalPose pose = Expressive(rig.skeleton());
  rig.Solve(pose);
  SubjectSolver solver(rig.binding());
  ASSERT_EQ(solver.Update(RestPose(rig.skeleton()), 0.0), JobStatus::kOk);
  ASSERT_EQ(solver.Update(pose, 1.0 / 60.0), JobStatus::kOk);
  EXPECT_LT(solver.wrinkle_weights()[0], rig.weights()[0]);
  EXPECT_GT(solver.wrinkle_weights()[0], 0.0f);
  EXPECT_EQ(solver.driver_values()[0], rig.values()[0]);
  EXPECT_LT(solver.filtered_values()[0], rig.values()[0]);
  for (int i = 0; i < 120; ++i) ASSERT_EQ(solver.Update(pose, 1.0 / 60.0), JobStatus::kOk);
  EXPECT_NEAR(solver.wrinkle_weights()[0], rig.weights()[0], 1e-3f);

  const float held = solver.wrinkle_weights()[0];
  ASSERT_EQ(solver.Decay(0.2), JobStatus::kOk);
  EXPECT_EQ(solver.wrinkle_weights()[0], held);
  for (int i = 0; i < 100; ++i) ASSERT_EQ(solver.Decay(0.1), JobStatus::kOk);
  for (const float weight : solver.wrinkle_weights()) EXPECT_EQ(weight, 0.0f);
}

TEST(SubjectSolver, AFailedUpdateChangesNothing) {
  BoundRig rig(MakeRig(), MakeBody());
  LocalPose pose = Expressive(rig.skeleton());
  SubjectSolver solver(rig.binding());
  ASSERT_EQ(solver.Update(pose, 0.0), JobStatus::kOk);
  const std::vector<float> weights(solver.wrinkle_weights().begin(),
                                   solver.wrinkle_weights().end());
  const std::vector<float> values(solver.driver_values().begin(), solver.driver_values().end());
  EXPECT_EQ(solver.Update(RestPose(rig.skeleton()), -1.0), JobStatus::kBadTime);
  EXPECT_EQ(solver.Decay(std::nan("")), JobStatus::kBadTime);
  pose.joints.pop_back();
  EXPECT_EQ(solver.Update(pose, 0.1), JobStatus::kSizeMismatch);
  pose = RestPose(rig.skeleton());
  pose.joints[4].translation.x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(solver.Update(pose, 0.1), JobStatus::kNonFinite);
  EXPECT_TRUE(std::equal(weights.begin(), weights.end(), solver.wrinkle_weights().begin()));
  EXPECT_TRUE(std::equal(values.begin(), values.end(), solver.driver_values().begin()));
}

TEST(SubjectSolver, ResetRestoresTheInitialState) {
  BoundRig rig(MakeRig(), MakeBody());
  const LocalPose pose = Expressive(rig.skeleton());
  SubjectSolver solver(rig.binding());
  ASSERT_EQ(solver.Update(RestPose(rig.skeleton()), 0.0), JobStatus::kOk);
  solver.Reset();
  for (const float weight : solver.wrinkle_weights()) EXPECT_EQ(weight, 0.0f);
  ASSERT_EQ(solver.Update(pose, 0.01), JobStatus::kOk);
  rig.Solve(pose);
  EXPECT_EQ(solver.wrinkle_weights()[0], rig.weights()[0]);  // the first input passes unchanged
}

// The allocation counter itself counts; otherwise the next test could not fail.
TEST(Allocation, IsCounted) {
  const std::uint64_t before = furrow::test::NumAllocations();
  const auto number = std::make_unique<int>(1);
  EXPECT_EQ(furrow::test::NumAllocations(), before + 1 + static_cast<std::uint64_t>(*number - 1));
}

TEST(Allocation, NoneAfterSetUp) {
  Rig test_rig = MakeRig();
  test_rig.drivers[0].pose.solve = PoseSolve::kNnls;
  BoundRig rig(test_rig, MakeBody(5));
  const Skeleton& skeleton = rig.skeleton();
  const Skeleton other = MakeBody(9);
  const Retarget retarget = Retarget::Create(skeleton, other);
  const LocalPose pose = Expressive(skeleton);
  std::vector<Transform> carried(pose.joints.size());
  std::vector<glm::mat4> model(pose.joints.size());
  std::vector<float> influences(pose.joints.size() * test_rig.wrinkle_maps.size());
  SubjectSolver solver(rig.binding());

  const std::uint64_t before = furrow::test::NumAllocations();
  bool ok = true;
  for (int frame = 0; frame < 10; ++frame) {
    const auto run = [&](const auto& job) { ok = ok && job.Run() == JobStatus::kOk; };
    run(LocalToModelJob{.skeleton = &skeleton, .local = pose.joints, .model = model});
    run(JointInfluenceJob{
        .binding = rig.binding().get(), .driver_values = rig.values(), .influences = influences});
    ok = ok && retarget.Run(pose.joints, carried) == JobStatus::kOk;
    ok = ok && solver.Update(pose, 0.01) == JobStatus::kOk;
    ok = ok && solver.Decay(0.01) == JobStatus::kOk;
  }
  solver.Reset();
  EXPECT_EQ(furrow::test::NumAllocations(), before);
  EXPECT_TRUE(ok);
}

}  // namespace
}  // namespace furrow::wrinkle
