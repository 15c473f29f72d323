// SPDX-License-Identifier: Apache-2.0
// The solver, by itself and in batches, against the oracle: on random rigs, poses and times, with
// every instruction set of this processor.
#include "wrinkle/solver/batch_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/allocation_counter.h"
#include "tests/unit/wrinkle/bound_rig.h"
#include "tests/unit/wrinkle/crowd.h"
#include "tests/unit/wrinkle/instruction_sets.h"

namespace furrow::wrinkle {
namespace {

float Uniform(std::mt19937* random, float from, float to) {
  return std::uniform_real_distribution<float>(from, to)(*random);
}
int Pick(std::mt19937* random, int count) {
  return std::uniform_int_distribution<int>(0, count - 1)(*random);
}

// A curve of moderate slope, because a steep one magnifies the small differences of its inputs.
std::vector<CurvePoint> RandomCurve(std::mt19937* random) {
  std::vector<CurvePoint> curve;
  const int steps = 2 + Pick(random, 4);
  for (int i = Pick(random, 2); i <= steps; ++i) {
    const float x = static_cast<float>(i) / static_cast<float>(steps);
    curve.push_back({x, std::clamp(x + Uniform(random, -0.1f, 0.1f), 0.0f, 1.0f)});
  }
  return curve;
}

const std::vector<std::string> kShapes = {"jawOpen", "a", "b", "c", "d", "e", "f"};

// Adds blend shapes to a pose driver, or replaces its joints by them.
void AddShapes(std::mt19937* random, PoseDriver* driver) {
  if (Pick(random, 3) == 0) driver->points.clear();
  const auto count = static_cast<std::size_t>(1 + Pick(random, static_cast<int>(kShapes.size())));
  for (std::size_t i = 0; i < count; ++i) {
    driver->points.push_back(
        {.joint = "", .kind = ControlPoint::Kind::kBlendShape, .blend_shape = kShapes[i]});
  }
}

// Drivers of every kind with random parameters, in random order.
Rig RandomRig(std::mt19937* random) {
  Rig rig = MakeRig();
  // Of its own, so that rigs of joints stay those with which the tolerance was chosen: a pose that
  // moves a point by 100 times its reference displacement has errors of several 1e-6.
  std::mt19937 of_shapes = *random;
  // Not small, because the quotients of small ones magnify the rounding in which the two differ.
  for (ReferencePose& pose : rig.reference_poses) {
    for (const std::string& shape : kShapes) {
      if (Pick(&of_shapes, 2) == 0) pose.shapes.push_back({shape, Uniform(&of_shapes, 0.5f, 1.0f)});
    }
  }
  if (Pick(random, 4) == 0) rig.anchor.clear();
  for (Driver& driver : rig.drivers) {
    driver.pose.solve = Pick(random, 3) == 0 ? PoseSolve::kNnls : PoseSolve::kProjection;
    const char* anchors[] = {"", "", "spine", "hand_l"};  // up and down again from the last two
    driver.pose.anchor = anchors[Pick(random, 4)];
    driver.pose.falloff = Pick(random, 2) == 0 ? 0.0f : Uniform(random, 0.2f, 2.0f);
    if (Pick(&of_shapes, 2) == 0) AddShapes(&of_shapes, &driver.pose);
    if (Pick(random, 3) == 0) driver.hinge.axis.reset();
    if (Pick(random, 2) == 0)
      driver.hinge.bone = glm::vec3(0.0f, -1.0f, Uniform(random, -0.5f, 0.5f));
    driver.hinge.beta_degrees = driver.ball.beta_degrees = Uniform(random, 10.0f, 120.0f);
    driver.ball.mode = Pick(random, 3) == 0 ? BallMode::kThesis : BallMode::kSmooth;
    driver.twist.full_degrees = Uniform(random, 30.0f, 180.0f);
    driver.blend_shape.neutral = Uniform(random, 0.0f, 0.3f);
    driver.blend_shape.full = Uniform(random, 0.5f, 1.0f);
  }
  std::shuffle(rig.drivers.begin(), rig.drivers.end(), *random);
  for (Region& region : rig.regions) {
    region.combine = static_cast<Combine>(Pick(random, 4));
    region.modulation = static_cast<Modulation>(Pick(random, 3));
    if (Pick(random, 4) == 0) region.curve = RandomCurve(random);
    if (Pick(random, 4) == 0) {
      region.feeds.back().modulation = static_cast<Modulation>(Pick(random, 3));
    }
    if (Pick(random, 4) == 0) region.feeds.front().curve = RandomCurve(random);
    region.feeds[0].sources.push_back({"jaw", "value", Uniform(random, 0.1f, 1.0f)});
  }
  rig.regions[1].neighbours = {"cheek_l", "mouth"};
  rig.filter = {.enabled = Pick(random, 5) != 0,
                .min_cutoff_hz = Uniform(random, 0.5f, 10.0f),
                .beta = Uniform(random, 0.0f, 5.0f),
                .derivative_cutoff_hz = Uniform(random, 0.5f, 5.0f),
                .slew_per_second = Pick(random, 3) == 0 ? 0.0f : Uniform(random, 1.0f, 60.0f)};
  return rig;
}

// Any pose from rest to the impossible.
void NextPose(const Skeleton& skeleton, std::mt19937* random, LocalPose* pose) {
  const float share = Pick(random, 4) == 0 ? 1.0f : Uniform(random, 0.0f, 0.2f);
  LocalPose wild;
  RandomPose(skeleton, random, &wild);
  pose->SetRest(skeleton);
  for (std::size_t i = 0; i < pose->joints.size(); ++i) {
    Transform& joint = pose->joints[i];
    joint.rotation = glm::slerp(joint.rotation, wild.joints[i].rotation, share);
    joint.translation = glm::mix(joint.translation, wild.joints[i].translation, share);
    joint.scale = glm::vec3(1.0f) + share * RandomVector(random, 0.2f);
  }
  // A stream may send fewer coefficients than the rig names.
  std::mt19937 of_shapes = *random;
  pose->blend_shapes.assign(Pick(random, 3) == 0 ? 0u : 1u, Uniform(random, -0.5f, 1.5f));
  if (pose->blend_shapes.empty()) return;
  pose->blend_shapes.resize(1 + static_cast<std::size_t>(Pick(&of_shapes, 7)));
  for (float& coefficient : std::span(pose->blend_shapes).subspan(1)) {
    coefficient = Uniform(&of_shapes, -0.5f, 1.5f);
  }
}

double NextStep(std::mt19937* random) {
  const double steps[] = {0.0, 1e-7, 1.0 / 240.0, 1.0 / 60.0, 1.0 / 60.0, 0.1, 3.0};
  return steps[Pick(random, 7)];
}

std::shared_ptr<const RigBinding> BindSeeded(const Rig& rig, unsigned frame_seed = 0) {
  return BoundRig(rig, MakeBody(frame_seed), kShapes).binding();
}

class BatchSolverTest : public InstructionSetTest {};
FURROW_FOR_INSTRUCTION_SETS(BatchSolverTest);

TEST_P(BatchSolverTest, EqualsTheOracleOnChanceRigsPosesAndTimes) {
  std::mt19937 random(71);
  for (int round = 0; round < 12; ++round) {
    Crowd crowd(BindSeeded(RandomRig(&random), static_cast<unsigned>(round % 3)), 37);
    BatchSolver batch;
    std::vector<BatchUpdate> updates;
    for (int frame = 0; frame < 25; ++frame) {
      updates.clear();
      for (std::size_t subject = 0; subject < crowd.size(); ++subject) {
        const int what = Pick(&random, 8);
        if (what == 0) continue;  // no pose came
        if (what == 1) {
          crowd.Decay(subject, NextStep(&random));
          continue;
        }
        NextPose(crowd.batched(subject).binding().skeleton(), &random, &crowd.pose(subject));
        updates.push_back(crowd.Update(subject, NextStep(&random)));
      }
      batch.Run(updates);
      crowd.ExpectStatuses(updates);
      crowd.ExpectEqual();
      if (HasFailure()) FAIL() << "round " << round << ", frame " << frame;
    }
  }
}

// Small errors must not add up: a slow filter, a thousand frames.
TEST_P(BatchSolverTest, StaysEqualOverAThousandFrames) {
  std::mt19937 random(72);
  Rig rig = MakeRig();
  rig.filter.min_cutoff_hz = 0.2f;
  rig.filter.beta = 0.1f;
  Crowd crowd(BindSeeded(rig, 5), 16);
  BatchSolver batch;
  std::vector<BatchUpdate> updates;
  for (int frame = 0; frame < 1000; ++frame) {
    updates.clear();
    for (std::size_t subject = 0; subject < crowd.size(); ++subject) {
      if (frame % 10 == 0) {
        NextPose(crowd.batched(subject).binding().skeleton(), &random, &crowd.pose(subject));
      }
      updates.push_back(crowd.Update(subject, 1.0 / 60.0));
    }
    batch.Run(updates);
  }
  crowd.ExpectEqual();
}

TEST_P(BatchSolverTest, AnyNumberOfSubjectsAndBindings) {
  std::mt19937 random(73);
  const auto first = BindSeeded(MakeRig(), 0);
  const auto second = BindSeeded(RandomRig(&random), 5);
  for (int count = 1; count <= 40; ++count) {
    Crowd one(first, count);
    Crowd other(second, count);
    BatchSolver batch;
    std::vector<BatchUpdate> updates;
    for (std::size_t i = 0; i < one.size(); ++i) {
      NextPose(first->skeleton(), &random, &one.pose(i));
      NextPose(second->skeleton(), &random, &other.pose(i));
      updates.push_back(one.Update(i, 0.0));
      if (i % 3 != 1) updates.push_back(other.Update(i, 0.0));
    }
    batch.Run(updates);
    one.ExpectEqual();
    other.ExpectEqual();
  }
}

TEST_P(BatchSolverTest, ASubjectMayAppearInABatchMoreThanOnce) {
  const auto binding = BindSeeded(MakeRig(), 5);
  std::mt19937 random(74);
  std::vector<LocalPose> poses(5);
  SubjectSolver single(binding);
  SubjectSolver batched(binding);
  std::vector<BatchUpdate> updates;
  for (LocalPose& pose : poses) {
    NextPose(binding->skeleton(), &random, &pose);
    ASSERT_EQ(single.Update(pose, 0.01), JobStatus::kOk);
    updates.push_back({.solver = &batched, .pose = &pose, .dt = 0.01});
  }
  BatchSolver batch;
  batch.Run(updates);
  EXPECT_TRUE(SameBits(single, batched));
}

// One stream of poses, by itself and at every place of batches of every length with other subjects
// of other rigs: all results have the same bits.
TEST_P(BatchSolverTest, ResultsHaveTheSameBitsAtAnyPlaceInAnyBatch) {
  std::mt19937 random(79);
  const auto binding = BindSeeded(RandomRig(&random), 5);
  const auto other = BindSeeded(RandomRig(&random), 0);
  std::vector<LocalPose> stream(20);
  for (LocalPose& pose : stream) NextPose(binding->skeleton(), &random, &pose);
  LocalPose noise;
  for (const std::size_t length : {1u, 2u, 7u, 16u, 33u, 300u}) {
    for (std::size_t place = 0; place < length; place += 1 + length / 5) {
      SubjectSolver single(binding);
      SubjectSolver batched(binding);
      std::vector<SubjectSolver> others(length, SubjectSolver(other));
      BatchSolver batch;
      for (const LocalPose& pose : stream) {
        NextPose(other->skeleton(), &random, &noise);
        std::vector<BatchUpdate> updates;
        for (std::size_t i = 0; i < length; ++i) {
          updates.push_back({.solver = &others[i], .pose = &noise, .dt = 0.02});
        }
        updates[place] = {.solver = &batched, .pose = &pose, .dt = 1.0 / 60.0};
        batch.Run(updates);
        ASSERT_EQ(single.Update(pose, 1.0 / 60.0), JobStatus::kOk);
        ASSERT_TRUE(SameBits(single, batched)) << length << " " << place;
      }
      ASSERT_EQ(single.Decay(0.4), JobStatus::kOk);
      ASSERT_EQ(batched.Decay(0.4), JobStatus::kOk);
      ASSERT_TRUE(SameBits(single, batched));
    }
  }
}

// Updates that fail report their status, change nothing, and do not affect other subjects.
TEST_P(BatchSolverTest, BadUpdatesFailAlone) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Rig rig = MakeRig();
  rig.anchor = "thigh_l";  // control points are carried up to the hips and down again
  const auto binding = BoundRig(rig, MakeBody(5)).binding();
  const std::size_t num_floats =
      static_cast<std::size_t>(binding->skeleton().num_joints()) * sizeof(Transform) / 4;
  std::mt19937 random(75);
  Crowd crowd(binding, 19);
  BatchSolver batch;
  std::vector<BatchUpdate> updates;
  // Every number of a pose in turn, whether a driver reads it or not.
  for (std::size_t number = 0; number < num_floats; ++number) {
    updates.clear();
    for (std::size_t i = 0; i < crowd.size(); ++i) {
      NextPose(binding->skeleton(), &random, &crowd.pose(i));
      if (i % 5 == number % 5) {
        (&crowd.pose(i).joints[0].translation.x)[number] = i % 2 == 0 ? kNan : -kInfinity;
      }
      if (i == 7) crowd.pose(i).joints.pop_back();
      if (i == 9) crowd.pose(i).blend_shapes = {0.0f, kNan};
      updates.push_back(crowd.Update(i, i == 11 ? -1.0 : i == 12 ? double{kNan} : 0.01));
    }
    batch.Run(updates);
    crowd.ExpectStatuses(updates);
    crowd.ExpectEqual();
    if (HasFailure()) FAIL() << "number " << number;
  }
  for (const std::size_t count : {1, 150}) {  // 300: looked at ahead of their turn
    std::vector<BatchUpdate> incomplete;
    for (std::size_t i = 0; i < count; ++i) {
      incomplete.push_back({.solver = &crowd.batched(0)});
      incomplete.push_back({.pose = &crowd.pose(0)});
    }
    batch.Run(incomplete);
    for (const BatchUpdate& update : incomplete) {
      EXPECT_EQ(update.status, JobStatus::kNullPointer);
    }
  }
}

// A pose with intermediate results that overflow is still solved.
TEST_P(BatchSolverTest, SurvivesDegeneratePoses) {
  const auto binding = BindSeeded(MakeRig(), 5);
  std::mt19937 random(76);
  Crowd crowd(binding, 18);
  std::vector<BatchUpdate> updates;
  for (std::size_t i = 0; i < crowd.size(); ++i) {
    NextPose(binding->skeleton(), &random, &crowd.pose(i));
    for (Transform& joint : crowd.pose(i).joints) {
      if (i % 3 == 0) joint.scale = joint.translation = glm::vec3(0.0f);
      if (i % 3 == 1) {
        joint.scale = glm::vec3(1e30f);
        joint.translation = glm::vec3(3e38f);
      }
    }
    updates.push_back(crowd.Update(i, 0.01));
  }
  BatchSolver batch;
  batch.Run(updates);
  crowd.ExpectStatuses(updates);
  crowd.ExpectEqual();
}

TEST_P(BatchSolverTest, SolvesStreamsWithoutJoints) {
  Rig rig;
  Driver jaw;
  jaw.name = "jaw";
  jaw.kind = Driver::Kind::kBlendShape;
  jaw.blend_shape = {.blend_shape = "jawOpen"};
  rig.drivers = {jaw};
  Crowd crowd(BoundRig(rig, Skeleton()).binding(), 3);
  std::vector<BatchUpdate> updates;
  for (std::size_t i = 0; i < crowd.size(); ++i) {
    crowd.pose(i).blend_shapes = {0.25f * static_cast<float>(i + 1)};
    updates.push_back(crowd.Update(i, 0.01));
  }
  BatchSolver().Run(updates);
  crowd.ExpectStatuses(updates);
  crowd.ExpectEqual();
  EXPECT_EQ(crowd.batched(2).driver_values()[0], 0.75f);
}

TEST_P(BatchSolverTest, LevelsOfDetailAreAPrefixOfTheDrivers) {
  std::mt19937 random(77);
  const Rig rig = RandomRig(&random);
  const auto binding = BindSeeded(rig, 5);
  Crowd crowd(binding, 40);
  BatchSolver batch;
  std::vector<BatchUpdate> updates;
  for (int frame = 0; frame < 10; ++frame) {
    updates.clear();
    for (std::size_t i = 0; i < crowd.size(); ++i) {
      if (frame % 4 == 0) crowd.SetLevel(i, (i + static_cast<std::size_t>(frame)) % 13);
      NextPose(binding->skeleton(), &random, &crowd.pose(i));
      updates.push_back(crowd.Update(i, 1.0 / 60.0));
    }
    batch.Run(updates);
    crowd.ExpectEqual();
  }
}

TEST_P(BatchSolverTest, DoesNotAllocateOnceItHasSeenASize) {
  Rig rig = MakeRig();
  rig.drivers[0].pose.solve = PoseSolve::kNnls;
  const auto binding = BindSeeded(rig, 5);
  const auto small = BindSeeded(MakeRig(), 0);
  std::vector<LocalPose> poses(50);
  std::vector<SubjectSolver> solvers;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    solvers.emplace_back(i % 5 == 0 ? small : binding);
    poses[i].SetRest(solvers[i].binding().skeleton());
  }
  std::vector<BatchUpdate> updates;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    updates.push_back({.solver = &solvers[i], .pose = &poses[i], .dt = 0.01});
  }
  BatchSolver batch;
  batch.Run(updates);
  const std::uint64_t before = furrow::test::NumAllocations();
  for (std::size_t count = 1; count <= updates.size(); ++count) {
    batch.Run(std::span(updates).last(count));
  }
  poses[3].joints[2].scale.x = std::numeric_limits<float>::infinity();
  batch.Run(updates);
  EXPECT_EQ(furrow::test::NumAllocations(), before);
  EXPECT_EQ(updates[3].status, JobStatus::kNonFinite);
}

// The meaning of a level, on single poses. The batch equals them (above).
TEST(LevelOfDetail, DriversPastThePrefixFadeAndTheOthersStay) {
  const auto binding = BindSeeded(MakeRig(), 5);
  std::mt19937 random(78);
  LocalPose pose;
  RandomPose(binding->skeleton(), &random, &pose);
  SubjectSolver whole(binding);
  SubjectSolver cut(binding);
  ASSERT_EQ(whole.Update(pose, 0.0), JobStatus::kOk);
  ASSERT_EQ(cut.Update(pose, 0.0), JobStatus::kOk);
  cut.set_num_drivers(2);  // brow_l, brow_r: two values each
  std::vector<float> before(cut.filtered_values().begin(), cut.filtered_values().end());
  for (int frame = 0; frame < 60; ++frame) {
    ASSERT_EQ(whole.Update(pose, 1.0 / 60.0), JobStatus::kOk);
    ASSERT_EQ(cut.Update(pose, 1.0 / 60.0), JobStatus::kOk);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const float now = cut.filtered_values()[i];
      if (i < 4) {
        EXPECT_EQ(now, whole.filtered_values()[i]);
      } else {
        EXPECT_LE(now, before[i]);
        EXPECT_TRUE(frame > 0 || before[i] == 0.0f || now > 0.0f) << "it jumps";
      }
      before[i] = now;
    }
  }
  for (std::size_t i = 4; i < before.size(); ++i) EXPECT_LT(before[i], 1e-3f);
}

}  // namespace
}  // namespace furrow::wrinkle
