// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/pose/pose_driver.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include "tests/unit/wrinkle/bound_rig.h"
#include "wrinkle/skeleton/retarget.h"

namespace furrow::wrinkle {
namespace {

// A pole of length 1 on a ground joint, which is the anchor. Drivers measure the pole's tail.
Skeleton Pole(unsigned frame_seed = 0) {
  return MakeSkeleton(
      {{"ground", "", {0, 0, 0}, {}}, {"pole", "ground", {0, 0, 0}, glm::vec3(0, 1, 0)}},
      frame_seed);
}

// Poses that move the pole's origin by given vectors.
Rig MoverRig(const std::vector<glm::vec3>& moves, PoseSolve solve, float falloff = 0.0f) {
  Rig rig;
  rig.anchor = "ground";
  Driver driver;
  driver.name = "d";
  driver.pose.points = {{.joint = "pole", .kind = ControlPoint::Kind::kOrigin}};
  driver.pose.solve = solve;
  driver.pose.falloff = falloff;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const std::string name = "p" + std::to_string(i);
    rig.reference_poses.push_back(
        {.name = name, .joints = {{"pole", {1.0f, 0.0f, 0.0f, 0.0f}, moves[i]}}});
    driver.pose.values.push_back({name, name});
  }
  rig.drivers = {driver};
  return rig;
}

LocalPose Moved(const Skeleton& skeleton, const glm::vec3& move) {
  LocalPose pose = RestPose(skeleton);
  Move(skeleton, "pole", move, &pose);
  return pose;
}

TEST(PoseDriver, ProjectsOntoTheDisplacement) {
  const Skeleton pole = Pole(6);
  BoundRig rig(MoverRig({{0, 2, 0}}, PoseSolve::kProjection), pole);
  EXPECT_NEAR(rig.ValueAt(Moved(pole, {0, 0, 0}), "d.p0"), 0.0f, 1e-6f);
  EXPECT_NEAR(rig.ValueAt(Moved(pole, {0, 2, 0}), "d.p0"), 1.0f, 1e-6f);
  EXPECT_NEAR(rig.ValueAt(Moved(pole, {7, 0.5f, -3}), "d.p0"), 0.25f, 1e-6f);  // across: ignored
  EXPECT_EQ(rig.ValueAt(Moved(pole, {0, -1, 0}), "d.p0"), 0.0f);
  EXPECT_EQ(rig.ValueAt(Moved(pole, {0, 9, 0}), "d.p0"), 1.0f);
}

TEST(PoseDriver, FalloffTellsMotionAcross) {
  const Skeleton pole = Pole();
  BoundRig rig(MoverRig({{0, 2, 0}}, PoseSolve::kProjection, 0.5f), pole);
  // One off, |d| = 2, s = 1/2: exp(-1 / (2 * 1/4 * 4)) = exp(-1/2).
  EXPECT_NEAR(rig.ValueAt(Moved(pole, {1, 1, 0}), "d.p0"), 0.5f * std::exp(-0.5f), 1e-6f);
  EXPECT_NEAR(rig.ValueAt(Moved(pole, {0, 1, 0}), "d.p0"), 0.5f, 1e-6f);
}

// Poses that are not orthogonal: projections count a motion twice, the fit does not.
TEST(PoseDriver, NnlsUnmixesWhatProjectionCountsTwice) {
  const Skeleton pole = Pole(3);
  const std::vector<glm::vec3> moves = {{1, 0, 0}, {1, 1, 0}, {0, 0.5f, 2}};
  BoundRig projection(MoverRig(moves, PoseSolve::kProjection), pole);
  EXPECT_NEAR(projection.ValueAt(Moved(pole, moves[0]), "d.p1"), 0.5f, 1e-6f);

  BoundRig nnls(MoverRig(moves, PoseSolve::kNnls), pole);
  for (std::size_t k = 0; k < 3; ++k) {
    nnls.Solve(Moved(pole, moves[k]));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(nnls.values()[i], i == k ? 1.0f : 0.0f, 1e-5f) << k << " " << i;
    }
  }
  nnls.Solve(Moved(pole, 0.3f * moves[0] + 0.6f * moves[1] + 0.1f * moves[2]));
  EXPECT_NEAR(nnls.values()[0], 0.3f, 1e-5f);
  EXPECT_NEAR(nnls.values()[1], 0.6f, 1e-5f);
  EXPECT_NEAR(nnls.values()[2], 0.1f, 1e-5f);
  nnls.Solve(RestPose(pole));
  for (const float value : nnls.values()) EXPECT_NEAR(value, 0.0f, 1e-6f);
}

TEST(PoseDriver, NnlsFalloffMeasuresWhatTheFitLeavesOver) {
  const Skeleton pole = Pole();
  BoundRig rig(MoverRig({{2, 0, 0}, {2, 2, 0}}, PoseSolve::kNnls, 1.0f), pole);
  rig.Solve(Moved(pole, {2, 0, 0}));
  EXPECT_NEAR(rig.values()[0], 1.0f, 1e-5f);  // inside the cone: nothing left over
  rig.Solve(Moved(pole, {2, 0, 2}));
  EXPECT_NEAR(rig.values()[0], std::exp(-0.5f), 1e-5f);  // |left over| = |d| = 2
}

// Holds for any rounding of the lengths: a product of floats may exceed the product of the lengths.
TEST(PoseDriver, PosesThatCoincideShare) {
  const Skeleton pole = Pole();
  std::mt19937 random(12);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  for (int i = 0; i < 200; ++i) {
    const glm::vec3 d(uniform(random), uniform(random), uniform(random));
    BoundRig rig(MoverRig({d, d, d}, PoseSolve::kNnls), pole);
    rig.Solve(Moved(pole, d));
    for (const float value : rig.values()) EXPECT_NEAR(value, 1.0f / 3.0f, 1e-3f) << i;
  }
}

// A joint that only rotates moves its tail and not its origin: the reason for control points.
TEST(PoseDriver, LooksAtTheTailOfAJointThatOnlyRotates) {
  const Skeleton pole = Pole(4);
  Rig rig;
  rig.anchor = "ground";
  rig.reference_poses = {{.name = "lean", .joints = {{"pole", AngleAxis(60.0f, {0, 0, 1})}}}};
  Driver driver;
  driver.name = "d";
  driver.pose.values = {{"lean", "lean"}};
  driver.pose.points = {{.joint = "pole", .kind = ControlPoint::Kind::kOrigin}};
  rig.drivers = {driver};
  EXPECT_EQ(BoundRig(rig, pole).binding()->warnings().size(), 1u);  // never fires

  rig.drivers[0].pose.points[0].kind = ControlPoint::Kind::kTail;
  BoundRig tail(rig, pole);
  EXPECT_TRUE(tail.binding()->warnings().empty());
  LocalPose pose = RestPose(pole);
  Turn(pole, "pole", AngleAxis(30.0f, {0, 0, 1}), &pose);
  // Tail from (0, 1) to (-sin a, cos a): chord of 30 onto chord of 60 degrees (unit vector at 150):
  // (-1/2, sqrt(3)/2 - 1) . (-sqrt(3)/2, -1/2) = sqrt(3)/4 - sqrt(3)/4 + 1/2.
  EXPECT_NEAR(tail.ValueAt(pose, "d.lean"), 0.5f, 1e-6f);
}

// With an anchor of its own, a driver does not see motion above that joint.
TEST(PoseDriver, MeasuresInTheSpaceOfItsOwnAnchor) {
  const Skeleton chain = MakeSkeleton({{"ground", "", {0, 0, 0}, {}},
                                       {"arm", "ground", {0, 1, 0}, {}},
                                       {"tip", "arm", {0, 2, 0}, glm::vec3(0, 3, 0)}},
                                      6);
  Rig rig;
  rig.anchor = "ground";
  rig.reference_poses = {{.name = "bent", .joints = {{"tip", AngleAxis(90.0f, {0, 0, 1})}}}};
  Driver driver;
  driver.pose.points = {{.joint = "tip"}};
  driver.pose.values = {{"bent", "bent"}};
  rig.drivers = {driver, driver};
  rig.drivers[0].name = "own";
  rig.drivers[0].pose.anchor = "arm";
  rig.drivers[1].name = "shared";
  BoundRig bound(rig, chain);
  EXPECT_TRUE(bound.binding()->warnings().empty());
  LocalPose pose = RestPose(chain);
  Turn(chain, "tip", AngleAxis(45.0f, {0, 0, 1}), &pose);
  bound.Solve(pose);
  // Tail from (0, 1) to (-s, s), s = sqrt(1/2), onto (-1, -1): (s + (1 - s)) / 2.
  EXPECT_NEAR(bound.Value("own.bent"), 0.5f, 1e-6f);
  EXPECT_NEAR(bound.Value("shared.bent"), 0.5f, 1e-6f);
  pose = RestPose(chain);
  Turn(chain, "arm", AngleAxis(30.0f, {0, 0, 1}), &pose);
  bound.Solve(pose);
  EXPECT_NEAR(bound.Value("own.bent"), 0.0f, 1e-6f);
  // The tail goes from (0, 2) to (-1, sqrt(3)) about the arm's origin: (1 + 2 - sqrt(3)) / 2.
  EXPECT_NEAR(bound.Value("shared.bent"), 0.6339746f, 1e-6f);
}

TEST(PoseDriver, OffsetPointIsInTheJointsSpaceAndScaled) {
  const Skeleton pole = Pole();
  Rig rig = MoverRig({{1, 0, 0}}, PoseSolve::kProjection);
  rig.reference_poses[0].joints[0] = {"pole", AngleAxis(90.0f, {0, 0, 1}), {-1, 0, 0}};
  ControlPoint& point = rig.drivers[0].pose.points[0];
  point = {.joint = "pole", .kind = ControlPoint::Kind::kOffset, .offset = {0, 3, 0}};
  LocalPose pose = RestPose(pole);
  Turn(pole, "pole", AngleAxis(90.0f, {0, 0, 1}), &pose);
  // An offset of 3s moves by (-3s, -3s), and in the reference pose, whose origin moves as well, by
  // (-3s - 1, -3s): (9s^2 + 3s + 9s^2) / ((3s + 1)^2 + 9s^2).
  EXPECT_NEAR(BoundRig(rig, pole).ValueAt(pose, "d.p0"), 21.0f / 25.0f, 1e-6f);
  point.offset_size = SkeletonSize(pole);
  EXPECT_NEAR(BoundRig(rig, pole).ValueAt(pose, "d.p0"), 21.0f / 25.0f, 1e-6f);
  point.offset_size = SkeletonSize(pole) / 2.0f;  // measured on a skeleton of half the size
  EXPECT_NEAR(BoundRig(rig, pole).ValueAt(pose, "d.p0"), 78.0f / 85.0f, 1e-6f);
}

// A pose recorded on one skeleton works on one of twice the size with other local frames.
TEST(PoseDriver, ReferencePosesCarryOverToOtherFramesAndSizes) {
  Rig rig = MakeRig();
  const Skeleton recorded = MakeBody();
  for (ReferencePose& pose : rig.reference_poses) pose.source_size = SkeletonSize(recorded);
  for (const Skeleton& skeleton : {MakeBody(0), MakeBody(21), MakeBody(22, 2.0f)}) {
    BoundRig bound(rig, skeleton);
    const float scale = SkeletonSize(skeleton) / SkeletonSize(recorded);
    LocalPose pose = RestPose(skeleton);
    Turn(skeleton, "brow_l", AngleAxis(-25.0f, {1, 0, 0}), &pose);
    Move(skeleton, "cheek_l", scale * glm::vec3(0.0f, 0.01f, 0.0025f), &pose);
    bound.Solve(pose);
    EXPECT_NEAR(bound.Value("brow_l.stretch"), 1.0f, 1e-5f);
    EXPECT_NEAR(bound.Value("cheek_l.squash"), 0.5f, 1e-4f);
  }
}

TEST(PoseDriver, SweepOfAReferencePoseIsContinuous) {
  BoundRig rig(MakeRig(), MakeBody(2));
  float worst = 0.0f;
  float before = 0.0f;
  for (int i = -300; i <= 300; ++i) {
    LocalPose pose = RestPose(rig.skeleton());
    Turn(rig.skeleton(), "brow_l", AngleAxis(static_cast<float>(i) * 0.1f, {1, 0, 0}), &pose);
    const float value = rig.ValueAt(pose, "brow_l.stretch");
    if (i > -300) worst = std::max(worst, std::abs(value - before));
    before = value;
  }
  std::printf("pose: at most %.6f per 0.1 degree\n", worst);
  // 25 degrees give 1: 0.004 a step on average; the chord of a circle varies by cos(25 degrees).
  EXPECT_LE(worst, 0.0045f);
}

}  // namespace
}  // namespace furrow::wrinkle
