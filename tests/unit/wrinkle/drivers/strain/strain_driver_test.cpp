// SPDX-License-Identifier: Apache-2.0
// Strain drivers on a patch with skin weights that run linearly from one joint to another. Moving a
// joint deforms the patch evenly and gives textbook strains, for any local frames of the joints.
#include "wrinkle/drivers/strain/strain_driver.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/wrinkle/bound_rig.h"
#include "wrinkle/rig/rig_check.h"

namespace furrow::wrinkle {
namespace {

constexpr float kHeight = 0.02f;  // of the patch
const glm::vec3 kUp(0.0f, 1.0f, 0.0f);
const glm::vec3 kRight(0.92847669f, 0.0f, -0.37139068f);  // along its rows: the viewer's right

Rig PatchRig(const glm::vec3& direction = kUp, float full_compression = 0.25f) {
  Rig rig;
  rig.drivers = {CheekPatch()};
  rig.drivers[0].strain.direction = direction;
  rig.drivers[0].strain.full_compression = full_compression;
  return rig;
}

class StrainDrivers : public testing::TestWithParam<unsigned> {
 protected:
  // The patch's values where its lowest row moves by `by`.
  static void Expect(BoundRig rig, const glm::vec3& by, float along, float across, float left,
                     float right) {
    LocalPose pose = RestPose(rig.skeleton());
    Move(rig.skeleton(), "cheek_l", by, &pose);
    rig.Solve(pose);
    EXPECT_NEAR(rig.Value("cheek_patch.along"), along, 2e-4f);
    EXPECT_NEAR(rig.Value("cheek_patch.across"), across, 2e-4f);
    EXPECT_NEAR(rig.Value("cheek_patch.diagonal_left"), left, 2e-4f);
    EXPECT_NEAR(rig.Value("cheek_patch.diagonal_right"), right, 2e-4f);
  }
  BoundRig Patch(const glm::vec3& direction = kUp, float full_compression = 0.25f) {
    return {PatchRig(direction, full_compression), MakeBody(GetParam())};
  }
};

INSTANTIATE_TEST_SUITE_P(LocalFrames, StrainDrivers, testing::Values(0u, 31u, 32u));

TEST_P(StrainDrivers, RestIsNothing) { Expect(Patch(), {}, 0, 0, 0, 0); }

TEST_P(StrainDrivers, CompressionAlongAndAcrossTheDirection) {
  Expect(Patch(), 0.1f * kHeight * kUp, 0.4f, 0, 0, 0);
  Expect(Patch(kUp, 0.5f), 0.1f * kHeight * kUp, 0.2f, 0, 0, 0);
  Expect(Patch(kRight), 0.1f * kHeight * kUp, 0, 0.4f, 0, 0);
  Expect(Patch(-kRight), 0.1f * kHeight * kUp, 0, 0.4f, 0, 0);
  // Up leans 45 degrees to the left of what points to the upper right.
  Expect(Patch(kUp + kRight), 0.1f * kHeight * kUp, 0, 0, 0.4f, 0);
}

TEST_P(StrainDrivers, StretchIsNoCompression) {
  Expect(Patch(), -0.3f * kHeight * kUp, 0, 0, 0, 0);
}

// Simple shear by g compresses to sqrt(1 + g^2/4) - g/2. With the lowest row moved to the viewer's
// right that is along the line that leans to the right, a little further than 45 degrees from up,
// since what stood upright is longer now.
TEST_P(StrainDrivers, ShearCompressesDiagonally) {
  const float g = 0.2f;
  const float compression = 1.0f - (std::sqrt(1.0f + 0.25f * g * g) - 0.5f * g);
  const float sine = 1.0f / std::sqrt(1.0f + 0.25f * g * g);  // of 2 phi: tan 2 phi = 2 / g
  const float diagonal = 4.0f * compression * sine * sine;
  const float rest = 4.0f * compression - diagonal;
  Expect(Patch(), g * kHeight * kRight, 0, rest, 0, diagonal);
  Expect(Patch(), -g * kHeight * kRight, 0, rest, diagonal, 0);
}

TEST_P(StrainDrivers, BeyondFullTheyStillSumToOne) {
  BoundRig rig = Patch(kUp, 0.1f);
  LocalPose pose = RestPose(rig.skeleton());
  Move(rig.skeleton(), "cheek_l", kHeight * (0.5f * kUp + 0.3f * kRight), &pose);
  rig.Solve(pose);
  float sum = 0.0f;
  for (const float value : rig.values()) sum += value;
  EXPECT_NEAR(sum, 1.0f, 1e-5f);
  EXPECT_GT(rig.Value("cheek_patch.along"), 0.3f);
  EXPECT_GT(rig.Value("cheek_patch.diagonal_right"), 0.1f);
}

TEST_P(StrainDrivers, MotionsOfTheHeadAndTheWholeChangeNoBit) {
  std::mt19937 random(3);
  BoundRig rig = Patch();
  LocalPose pose = RestPose(rig.skeleton());
  Move(rig.skeleton(), "cheek_l", {0.003f, 0.004f, 0.001f}, &pose);
  rig.Solve(pose);
  const std::vector<float> before = rig.values();
  for (int round = 0; round < 50; ++round) {
    pose.joints[0].translation = RandomVector(&random, 1000.0f);
    pose.joints[0].rotation = RandomRotation(&random);
    Turn(rig.skeleton(), "head", RandomRotation(&random), &pose);
    rig.Solve(pose);
    EXPECT_EQ(rig.values(), before);
  }
}

TEST_P(StrainDrivers, TheSkeletonsSizeDoesNotMatter) {
  BoundRig large(PatchRig(), MakeBody(GetParam(), 100.0f));
  Expect(large, 10.0f * kHeight * kUp, 0.4f, 0, 0, 0);
}

TEST_P(StrainDrivers, SweepIsContinuous) {
  BoundRig rig = Patch();
  std::vector<float> before;
  float worst = 0.0f;
  for (int i = 0; i <= 3600; ++i) {
    const float degrees = 0.1f * static_cast<float>(i);
    LocalPose pose = RestPose(rig.skeleton());
    const float radians = glm::radians(degrees);
    Move(rig.skeleton(), "cheek_l",
         0.2f * kHeight * (std::cos(radians) * kUp + std::sin(radians) * kRight), &pose);
    rig.Solve(pose);
    for (std::size_t k = 0; k < before.size(); ++k) {
      worst = std::max(worst, std::abs(rig.values()[k] - before[k]));
    }
    before = rig.values();
  }
  std::printf("strain: at most %.6f per 0.1 degree\n", worst);
  EXPECT_LE(worst, 0.005f);
  EXPECT_GT(worst, 0.0f);
}

// The patch's lowest row moved by `by`, the middle row by half of it, as the cheek's joint does.
StrainDriver::Shape LowRowShape(const std::string& name, const glm::vec3& by) {
  StrainDriver::Shape shape{.blend_shape = name};
  const Driver patch = CheekPatch();
  for (std::size_t i = 0; i < patch.strain.vertices.size(); ++i) {
    const float share = patch.strain.vertices[i].skin_weights[1];
    if (share == 0.0f) continue;
    shape.vertices.push_back(static_cast<int>(i));
    for (int axis = 0; axis < 3; ++axis) shape.deltas.push_back(share * by[axis]);
  }
  return shape;
}

Rig ShapedRig() {
  Rig rig = PatchRig();
  rig.drivers[0].strain.shapes = {LowRowShape("Puff", 0.1f * kHeight * kUp),
                                  LowRowShape("slide", 0.2f * kHeight * kRight)};
  return rig;
}

LocalPose WithShapes(const Skeleton& skeleton, const std::vector<float>& coefficients) {
  LocalPose pose = RestPose(skeleton);
  pose.blend_shapes = coefficients;
  return pose;
}

TEST_P(StrainDrivers, BlendShapesFoldThePatchAsJointsDo) {
  BoundRig rig(ShapedRig(), MakeBody(GetParam()), {"puff", "slide"});
  EXPECT_NEAR(rig.ValueAt(WithShapes(rig.skeleton(), {1, 0}), "cheek_patch.along"), 0.4f, 2e-4f);
  EXPECT_NEAR(rig.ValueAt(WithShapes(rig.skeleton(), {0.5f, 0}), "cheek_patch.along"), 0.2f, 2e-4f);
  EXPECT_NEAR(rig.ValueAt(WithShapes(rig.skeleton(), {0, 0}), "cheek_patch.along"), 0.0f, 2e-4f);
  EXPECT_NEAR(rig.ValueAt(WithShapes(rig.skeleton(), {}), "cheek_patch.along"), 0.0f, 2e-4f);
  // Shapes add up with each other and with joints.
  LocalPose both = WithShapes(rig.skeleton(), {0.5f, 1.0f});
  rig.Solve(both);
  const std::vector<float> with_shapes = rig.values();
  LocalPose joints = RestPose(rig.skeleton());
  Move(rig.skeleton(), "cheek_l", kHeight * (0.05f * kUp + 0.2f * kRight), &joints);
  rig.Solve(joints);
  for (std::size_t i = 0; i < with_shapes.size(); ++i) {
    EXPECT_NEAR(with_shapes[i], rig.values()[i], 2e-4f);
  }
  EXPECT_GT(rig.Value("cheek_patch.diagonal_right"), 0.2f);
  both = WithShapes(rig.skeleton(), {0.5f, 0.0f});
  Move(rig.skeleton(), "cheek_l", 0.05f * kHeight * kUp, &both);
  EXPECT_NEAR(rig.ValueAt(both, "cheek_patch.along"), 0.4f, 2e-4f);
}

TEST_P(StrainDrivers, ShapesTurnWithTheHead) {
  std::mt19937 random(7);
  BoundRig rig(ShapedRig(), MakeBody(GetParam()), {"puff", "slide"});
  LocalPose pose = WithShapes(rig.skeleton(), {0.7f, 0.4f});
  rig.Solve(pose);
  const std::vector<float> before = rig.values();
  for (int round = 0; round < 20; ++round) {
    pose.joints[0].translation = RandomVector(&random, 1000.0f);
    pose.joints[0].rotation = RandomRotation(&random);
    Turn(rig.skeleton(), "head", RandomRotation(&random), &pose);
    rig.Solve(pose);
    EXPECT_EQ(rig.values(), before);
  }
}

TEST_P(StrainDrivers, ShapesScaleWithTheSkeleton) {
  BoundRig large(ShapedRig(), MakeBody(GetParam(), 100.0f), {"puff", "slide"});
  EXPECT_NEAR(large.ValueAt(WithShapes(large.skeleton(), {1, 0}), "cheek_patch.along"), 0.4f,
              2e-4f);
}

// A phone sends coefficients and no joints, so the patch follows its shapes alone.
TEST(StrainDriver, ShapesNeedNoJoints) {
  const Skeleton phone = *Skeleton::Create({{"phone", -1, {}, {}}});
  auto binding = RigBinding::Create(ShapedRig(), phone, std::vector<std::string>{"slide", "PUFF"},
                                    {.allow_missing = true});
  ASSERT_TRUE(binding.ok()) << binding.status().ToString();
  SubjectSolver solver(std::make_shared<const RigBinding>(*std::move(binding)), false);
  ASSERT_EQ(solver.Update(WithShapes(phone, {0, 1}), 0.0), JobStatus::kOk);
  EXPECT_NEAR(solver.driver_values()[0], 0.4f, 2e-4f);
}

// Only the joint of the lowest row is missing: it stays where it is on the head.
TEST(StrainDriver, ShapesReplaceAMissingJoint) {
  Rig rig = ShapedRig();
  rig.drivers[0].strain.joints[1] = "jowl";
  const Skeleton body = MakeBody();
  auto binding =
      RigBinding::Create(rig, body, std::vector<std::string>{"puff"}, {.allow_missing = true});
  ASSERT_TRUE(binding.ok()) << binding.status().ToString();
  EXPECT_THAT(
      std::vector(binding->missing_blend_shapes().begin(), binding->missing_blend_shapes().end()),
      testing::ElementsAre("slide"));
  SubjectSolver solver(std::make_shared<const RigBinding>(*std::move(binding)), false);
  LocalPose pose = WithShapes(body, {1});
  Turn(body, "head", {0.8f, 0.0f, 0.6f, 0.0f}, &pose);
  ASSERT_EQ(solver.Update(pose, 0.0), JobStatus::kOk);
  EXPECT_NEAR(solver.driver_values()[0], 0.4f, 2e-4f);
}

TEST(StrainDriver, RefusesFaultyShapes) {
  const auto status_of = [](auto change) {
    Rig rig = ShapedRig();
    change(&rig.drivers[0].strain.shapes[1]);
    return CheckRigFields(rig).ToString();
  };
  using Shape = StrainDriver::Shape;
  EXPECT_THAT(status_of([](Shape* s) { s->vertices[0] = 9; }),
              testing::HasSubstr("not below the number of vertices"));
  EXPECT_THAT(status_of([](Shape* s) { s->vertices[0] = -1; }),
              testing::HasSubstr("drivers[0].strain.shapes[1].vertices"));
  EXPECT_THAT(status_of([](Shape* s) { s->vertices[1] = s->vertices[0]; }),
              testing::HasSubstr("a vertex occurs twice"));
  EXPECT_THAT(status_of([](Shape* s) { s->deltas.pop_back(); }),
              testing::HasSubstr("three numbers per vertex"));
  EXPECT_THAT(status_of([](Shape* s) { s->deltas[0] = std::nanf(""); }),
              testing::HasSubstr("not finite"));
  EXPECT_THAT(status_of([](Shape* s) { s->blend_shape = "pufF"; }),
              testing::HasSubstr("the blend shape occurs twice"));
}

TEST(StrainDriver, WithoutItsJointsItRests) {
  Rig rig = PatchRig();
  rig.drivers[0].strain.joints[1] = "jowl";
  const Skeleton body = MakeBody();
  auto binding = RigBinding::Create(rig, body, {}, {.allow_missing = true});
  ASSERT_TRUE(binding.ok()) << binding.status().ToString();
  EXPECT_EQ(binding->missing_joints().size(), 1u);
  SubjectSolver solver(std::make_shared<const RigBinding>(*std::move(binding)));
  ASSERT_EQ(solver.Update(RestPose(body), 0.0), JobStatus::kOk);
  for (const float value : solver.driver_values()) EXPECT_EQ(value, 0.0f);
}

TEST(StrainDriver, AnswersForTheJointsThatMoveItsPatch) {
  Rig rig = PatchRig();
  rig.wrinkle_maps = {{.name = "squash"}};
  rig.regions.resize(1);
  rig.regions[0].name = "cheek";
  rig.regions[0].mask.kind = Mask::Kind::kSkinning;
  rig.regions[0].modulation = Modulation::kLinear;
  rig.regions[0].feeds = {{"squash", {{"cheek_patch", "along", 1.0f}}}};
  BoundRig bound(rig, MakeBody());
  LocalPose pose = RestPose(bound.skeleton());
  Move(bound.skeleton(), "cheek_l", 0.1f * kHeight * kUp, &pose);
  bound.Solve(pose);
  std::vector<float> influences(pose.joints.size());
  const JointInfluenceJob job{
      .binding = bound.binding().get(), .driver_values = bound.values(), .influences = influences};
  ASSERT_EQ(job.Run(), JobStatus::kOk);
  EXPECT_NEAR(influences[bound.skeleton().Find("cheek_l")], 0.4f, 1e-4f);
  EXPECT_NEAR(influences[bound.skeleton().Find("head")], 0.4f, 1e-4f);
  EXPECT_EQ(influences[bound.skeleton().Find("neck")], 0.0f);
}

}  // namespace
}  // namespace furrow::wrinkle
