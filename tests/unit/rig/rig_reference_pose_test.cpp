// SPDX-License-Identifier: Apache-2.0
#include "rig/rig_reference_pose.h"

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "wrinkle/skeleton/retarget.h"
#include "wrinkle/solver/subject_solver.h"

namespace furrow::rig {
namespace {

using wrinkle::PoseFrame;

constexpr float kPi = 3.14159265f;

glm::quat Turn(float degrees, glm::vec3 axis) {
  return glm::angleAxis(degrees * kPi / 180.0f, axis);
}

// A root that is turned by 90 degrees about Z at rest, and a child at 1 unit along the root's X
// axis.
PoseFrame TurnedRoot() {
  PoseFrame frame;
  frame.skeleton =
      *wrinkle::Skeleton::Create({{"root", -1, {glm::vec3(0), Turn(90, {0, 0, 1})}, {}},
                                  {"child", 0, {glm::vec3(1, 0, 0)}, glm::vec3(1, 0, 0)}});
  frame.pose.SetRest(frame.skeleton);
  return frame;
}

TEST(RigReferencePose, RestPoseMovesNoJoints) {
  const auto pose = ReferencePoseFromFrame("rest", TurnedRoot());
  ASSERT_TRUE(pose.ok());
  EXPECT_TRUE(pose->joints.empty());
  EXPECT_GT(pose->source_size, 0.0f);
}

TEST(RigReferencePose, UsesModelAxes) {
  PoseFrame frame = TurnedRoot();
  // A turn about the child's X axis and a move along the root's X axis; both are the model's Y
  // axis.
  frame.pose.joints[1].rotation = Turn(30, {1, 0, 0});
  frame.pose.joints[1].translation += glm::vec3(0.25f, 0, 0);
  const auto pose = ReferencePoseFromFrame("p", frame);
  ASSERT_TRUE(pose.ok());
  ASSERT_EQ(pose->joints.size(), 1u);
  EXPECT_NEAR(pose->joints[0].rotation.y, std::sin(15.0f * kPi / 180.0f), 1e-6);
  EXPECT_NEAR(pose->joints[0].rotation.x, 0.0f, 1e-6);
  EXPECT_NEAR(pose->joints[0].translation.y, 0.25f, 1e-6);
  EXPECT_NEAR(pose->joints[0].translation.x, 0.0f, 1e-6);
}

TEST(RigReferencePose, AcceptsAnotherFrameAsRest) {
  PoseFrame rest = TurnedRoot();
  PoseFrame frame = TurnedRoot();
  rest.pose.joints[1].rotation = Turn(10, {0, 1, 0});
  frame.pose.joints[1].rotation = Turn(25, {0, 1, 0});
  const auto same = ReferencePoseFromFrame("p", rest, &rest);
  ASSERT_TRUE(same.ok());
  EXPECT_TRUE(same->joints.empty());
  const auto pose = ReferencePoseFromFrame("p", frame, &rest);
  ASSERT_TRUE(pose.ok());
  ASSERT_EQ(pose->joints.size(), 1u);
  EXPECT_NEAR(pose->joints[0].rotation.w, std::cos(7.5f * kPi / 180.0f), 1e-6);
}

// The value of a pose driver that compares the joint "brow" with `up` in the space of the head.
float BrowValue(const wrinkle::Skeleton& skeleton, const wrinkle::ReferencePose& up,
                const PoseFrame& live) {
  wrinkle::Rig rig;
  rig.anchor = "head";
  rig.reference_poses = {up};
  rig.drivers.resize(1);
  rig.drivers[0].name = "brow";
  rig.drivers[0].pose.points = {{.joint = "brow"}};
  rig.drivers[0].pose.values = {{"up", "up"}};
  auto binding = wrinkle::RigBinding::Create(rig, skeleton, {});
  EXPECT_TRUE(binding.ok()) << binding.status().ToString();
  wrinkle::SubjectSolver solver(std::make_shared<const wrinkle::RigBinding>(*std::move(binding)),
                                false);
  EXPECT_EQ(solver.Update(live.pose, 0.0), wrinkle::JobStatus::kOk);
  return solver.driver_values()[0];
}

// Hips, neck, head and a brow, all with local frames of their own.
class Performer : public testing::Test {
 protected:
  PoseFrame Rest() const {
    PoseFrame frame{skeleton_, {}};
    frame.pose.SetRest(skeleton_);
    return frame;
  }
  // The brow raised by `strength`.
  PoseFrame Raised(float strength) const {
    PoseFrame frame = Rest();
    wrinkle::Transform& brow = frame.pose.joints[3];
    brow.rotation = brow.rotation * Turn(-20.0f * strength, {1, 0, 0});
    brow.translation += strength * glm::vec3(0.001f, 0.004f, -0.002f);
    return frame;
  }
  glm::quat RandomTurn() {
    std::normal_distribution<float> normal;
    return glm::normalize(
        glm::quat(normal(random_), normal(random_), normal(random_), normal(random_)));
  }
  // Moves and turns the whole character, and tilts the head.
  void MoveAround(PoseFrame* frame) {
    std::uniform_real_distribution<float> place(-50.0f, 50.0f);
    wrinkle::Transform& hips = frame->pose.joints[0];
    hips.rotation = RandomTurn() * hips.rotation;
    hips.translation += glm::vec3(place(random_), place(random_), place(random_));
    for (int joint : {1, 2}) frame->pose.joints[joint].rotation = RandomTurn();
  }
  // The value of `live`, with the reference pose taken from `frame` and `rest`.
  float Value(const PoseFrame& frame, const PoseFrame* rest, const PoseFrame& live) const {
    return BrowValue(skeleton_, *ReferencePoseFromFrame("up", frame, rest), live);
  }

  std::mt19937 random_{21};
  wrinkle::Skeleton skeleton_ = *wrinkle::Skeleton::Create(
      {{"hips", -1, {{0, 1, 0}, Turn(25, {0.6f, 0.8f, 0})}, {}},
       {"neck", 0, {{0, 0.5f, 0}, Turn(-40, {0, 0, 1})}, {}},
       {"head", 1, {{0, 0.1f, 0}, Turn(70, {1, 0, 0})}, {}},
       {"brow", 2, {{0.03f, 0.1f, 0.08f}, Turn(100, {0, 1, 0})}, glm::vec3(0, 0.01f, 0.05f)}});
};

TEST_F(Performer, RigidMotionOfReferenceRestOrLivePoseChangesNothing) {
  for (const float strength : {0.3f, 0.7f, 1.0f}) {
    const PoseFrame neutral = Rest();
    const float expected = Value(Raised(1.0f), &neutral, Raised(strength));
    if (strength == 1.0f) {
      EXPECT_NEAR(expected, 1.0f, 1e-5f);
    }
    for (int round = 0; round < 50; ++round) {
      PoseFrame frame = Raised(1.0f);
      PoseFrame rest = Rest();
      PoseFrame live = Raised(strength);
      if (round % 4 != 1) MoveAround(&frame);
      if (round % 4 != 2) MoveAround(&rest);
      if (round % 4 != 3) MoveAround(&live);
      EXPECT_NEAR(Value(frame, &rest, live), expected, 1e-5f) << round;
      // Without a rest frame, the skeleton's own rest pose counts.
      EXPECT_NEAR(Value(frame, nullptr, live), expected, 1e-5f) << round;
    }
  }
}

// The same face with a brow that does not hang from the head: from the hips, or from nothing.
class FlatPerformer : public testing::TestWithParam<int> {
 protected:
  static constexpr glm::vec3 kBrow{0.03f, 1.7f, 0.1f};

  PoseFrame Rest() const {
    PoseFrame frame{skeleton_, {}};
    frame.pose.SetRest(skeleton_);
    return frame;
  }
  // The brow raised by `strength` on a head that `place` and `turn` put elsewhere.
  PoseFrame Raised(float strength, const glm::quat& turn, const glm::vec3& place) const {
    PoseFrame frame = Rest();
    wrinkle::Transform& neck = frame.pose.joints[1];
    neck.rotation = turn;
    neck.translation += place;
    const glm::vec3 pivot = glm::vec3(0, 1.5f, 0) + place;  // of the neck
    const glm::vec3 raised = kBrow + strength * glm::vec3(0.001f, 0.004f, -0.002f);
    wrinkle::Transform& brow = frame.pose.joints[3];
    brow.translation = pivot + turn * (raised - glm::vec3(0, 1.5f, 0)) - Above();
    brow.rotation = turn * Turn(-20.0f * strength, {1, 0, 0});
    return frame;
  }
  float Value(const PoseFrame& frame, const PoseFrame* rest, const PoseFrame& live) const {
    return BrowValue(skeleton_, *ReferencePoseFromFrame("up", frame, rest, {{"brow", "head"}}),
                     live);
  }
  // The place of the brow's parent.
  static glm::vec3 Above() {
    return GetParam() == wrinkle::kNoJoint ? glm::vec3(0) : glm::vec3(0, 1, 0);
  }

  wrinkle::Skeleton skeleton_ =
      *wrinkle::Skeleton::Create({{"hips", -1, {{0, 1, 0}}, {}},
                                  {"neck", 0, {{0, 0.5f, 0}}, {}},
                                  {"head", 1, {{0, 0.1f, 0}}, {}},
                                  {"brow", GetParam(), {kBrow - Above()}, glm::vec3(0, 0, 0.05f)},
                                  {"arm", 0, {{0.2f, 0.4f, 0}}, {}}});
};

TEST_P(FlatPerformer, HeadsThatTurnDoNotEnterThePose) {
  const glm::quat straight(1, 0, 0, 0);
  const PoseFrame half = Raised(0.5f, straight, {});
  const PoseFrame neutral = Rest();
  const float expected = Value(Raised(1.0f, straight, {}), &neutral, half);
  EXPECT_NEAR(expected, 0.5f, 0.05f);
  const glm::quat turns[] = {straight, Turn(90, {0, 1, 0}), Turn(-170, {0.6f, 0.8f, 0}),
                             Turn(40, {1, 0, 0})};
  const glm::vec3 away(2.0f, -0.3f, 7.0f);
  for (const glm::quat& turn : turns) {
    const PoseFrame rest = Raised(0.0f, turn, away);
    EXPECT_NEAR(Value(Raised(1.0f, turn, away), &rest, half), expected, 2e-4f);
    // The head turns between the rest frame and the pose.
    EXPECT_NEAR(Value(Raised(1.0f, straight, {}), &rest, half), expected, 2e-4f);
    EXPECT_NEAR(Value(Raised(1.0f, turn, away), &neutral, half), expected, 2e-4f);
    EXPECT_NEAR(Value(Raised(1.0f, turn, away), nullptr, half), expected, 2e-4f);
  }
}

// An arm does not go with the head, so it is compared with itself.
TEST_P(FlatPerformer, OtherJointsStayInTheirOwnSpace) {
  const PoseFrame rest = Raised(0.0f, Turn(60, {0, 1, 0}), {});
  PoseFrame frame = rest;
  frame.pose.joints[4].rotation = Turn(30, {1, 0, 0});
  const auto plain = ReferencePoseFromFrame("p", frame, &rest);
  const auto anchored = ReferencePoseFromFrame("p", frame, &rest, {{"arm", "head"}});
  ASSERT_TRUE(plain.ok() && anchored.ok());
  ASSERT_EQ(anchored->joints.size(), 1u);
  EXPECT_EQ(anchored->joints[0].joint, "arm");
  EXPECT_EQ(anchored->joints[0].rotation, plain->joints[0].rotation);
}

INSTANTIATE_TEST_SUITE_P(Parents, FlatPerformer, testing::Values(wrinkle::kNoJoint, 0));

// A brow that is drawn sideways, on a performer who faces another way.
TEST_F(Performer, AFaceTurnedAsideReadsOneInItsOwnFrame) {
  const glm::quat head = skeleton_.rest_model_rotations()[2];
  for (const float heading : {0.0f, 90.0f, 180.0f}) {
    PoseFrame frame = Rest();
    frame.pose.joints[3].translation += glm::conjugate(head) * glm::vec3(-0.004f, 0, 0.001f);
    PoseFrame rest = Rest();
    for (PoseFrame* turned : {&frame, &rest}) {
      wrinkle::Transform& hips = turned->pose.joints[0];
      hips.rotation = Turn(heading, {0, 1, 0}) * hips.rotation;
    }
    EXPECT_NEAR(Value(frame, &rest, frame), 1.0f, 1e-5f) << heading;
  }
}

TEST(RigReferencePose, RejectsPosesThatDoNotFitTheSkeleton) {
  PoseFrame frame = TurnedRoot();
  frame.pose.joints.pop_back();
  EXPECT_EQ(ReferencePoseFromFrame("p", frame).status().code(), StatusCode::kInvalidArgument);
  frame = TurnedRoot();
  frame.pose.joints[1].translation.x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(ReferencePoseFromFrame("p", frame).status().code(), StatusCode::kNonFinite);
}

// A frame of a phone: coefficients and no joints.
PoseFrame Phone(std::vector<float> coefficients) {
  PoseFrame frame;
  frame.blend_shape_names = {"browDownLeft", "mouthSmileLeft", "HeadYaw", "", "BROWDOWNLEFT"};
  frame.pose.blend_shapes = std::move(coefficients);
  return frame;
}

TEST(RigReferencePose, TakesTheBlendShapesOfAFrame) {
  const PoseFrame frame = Phone({0.75f, 0.0005f, 0.3f, 0.9f, 0.1f});
  auto pose = ReferencePoseFromFrame("p", frame);
  ASSERT_TRUE(pose.ok()) << pose.status().ToString();
  EXPECT_TRUE(pose->joints.empty());
  // Neither noise, nor angles of the head, nor what has no name; the first of equal names.
  EXPECT_EQ(pose->shapes, (std::vector<wrinkle::ShapeValue>{{"browDownLeft", 0.75f}}));
  const PoseFrame rest = Phone({0.25f, 0.5f, 0, 0, 0});
  pose = ReferencePoseFromFrame("p", frame, &rest);
  ASSERT_TRUE(pose.ok());
  EXPECT_EQ(pose->shapes, (std::vector<wrinkle::ShapeValue>{{"browDownLeft", 0.5f},
                                                            {"mouthSmileLeft", -0.4995f}}));
}

TEST(RigReferencePose, RejectsBlendShapesThatDoNotFitTheirNames) {
  const PoseFrame frame = Phone({0.75f, 0, 0.3f, 0, 0});
  EXPECT_EQ(ReferencePoseFromFrame("p", Phone({0.75f})).status().code(),
            StatusCode::kInvalidArgument);
  const PoseFrame short_rest = Phone({0.5f, 0});
  EXPECT_EQ(ReferencePoseFromFrame("p", frame, &short_rest).status().code(),
            StatusCode::kInvalidArgument);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto bad = ReferencePoseFromFrame("p", Phone({0, nan, 0, 0, 0}));
  EXPECT_EQ(bad.status().code(), StatusCode::kNonFinite);
  EXPECT_NE(bad.status().what().find("'mouthSmileLeft'"), std::string::npos);
}

TEST(RigReferencePose, MixesScaleAndSumBlendShapes) {
  const wrinkle::ReferencePose a{.name = "a", .shapes = {{"jawOpen", 0.5f}, {"smile", 1.0f}}};
  const wrinkle::ReferencePose b{.name = "b", .shapes = {{"frown", 0.25f}, {"JAWOPEN", 1.0f}}};
  const WeightedPose parts[] = {{&a, 0.5f}, {&b, -2.0f}};
  EXPECT_EQ(MixReferencePoses("m", parts).shapes,
            (std::vector<wrinkle::ShapeValue>{
                {"jawOpen", 0.25f - 2.0f}, {"smile", 0.5f}, {"frown", -0.5f}}));
}

TEST(RigReferencePose, MixesScaleRotationVectors) {
  wrinkle::ReferencePose a{"a", {{"j", Turn(40, {1, 0, 0}), {0, 0, 2}}}, 2.0f};
  wrinkle::ReferencePose b{
      "b", {{"j", -Turn(20, {1, 0, 0}), {0, 0, 1}}, {"k", Turn(9, {0, 1, 0}), {}}}, 4.0f};
  const WeightedPose parts[] = {{&a, 0.5f}, {&b, -2.0f}};
  const auto mix = MixReferencePoses("m", parts);
  EXPECT_EQ(mix.source_size, 2.0f);
  ASSERT_EQ(mix.joints.size(), 2u);
  // 40 * 0.5 - 20 * 2 = -20 degrees; the sign of a quaternion does not matter.
  EXPECT_NEAR(mix.joints[0].rotation.x, std::sin(-10.0f * kPi / 180.0f), 1e-6);
  EXPECT_NEAR(mix.joints[0].translation.z, 2.0f * 0.5f - 2.0f * 1.0f * (2.0f / 4.0f), 1e-6);
  EXPECT_NEAR(mix.joints[1].rotation.y, std::sin(-9.0f * kPi / 180.0f), 1e-6);
}

// A pose without a size is in the bound skeleton's units, also in a mix with a pose that has one.
TEST(RigReferencePose, MixesPosesWithAndWithoutASize) {
  const wrinkle::Skeleton skeleton =
      *wrinkle::Skeleton::Create({{"root", -1, {}, {}}, {"j", 0, {glm::vec3(0, 5, 0)}, {}}});
  ASSERT_EQ(wrinkle::SkeletonSize(skeleton), 5.0f);
  const wrinkle::ReferencePose sized{"a", {{.joint = "j", .translation = {0, 0, 1}}}, 2.0f};
  const wrinkle::ReferencePose plain{"b", {{.joint = "j", .translation = {1, 0, 0}}}, 0.0f};
  const WeightedPose one_way[] = {{&sized, 0.2f}, {&plain, 0.5f}};
  const WeightedPose other_way[] = {{&plain, 0.5f}, {&sized, 0.2f}};
  for (const auto& parts : {one_way, other_way}) {
    const auto mix = MixReferencePoses("m", std::span(parts, 2));
    const WeightedPose again[] = {{&mix, 2.0f}};
    const auto twice = MixReferencePoses("t", again);
    std::vector<wrinkle::Transform> locals(2);
    ASSERT_TRUE(wrinkle::ApplyReferencePose(mix, skeleton, locals).ok());
    EXPECT_NEAR(locals[1].translation.x, 0.5f, 1e-6f);
    EXPECT_NEAR(locals[1].translation.z, 0.2f * 5.0f / 2.0f, 1e-6f);
    ASSERT_TRUE(wrinkle::ApplyReferencePose(twice, skeleton, locals).ok());
    EXPECT_NEAR(locals[1].translation.x, 0.5f + 1.0f, 1e-6f);
    EXPECT_NEAR(locals[1].translation.z, 0.5f + 1.0f, 1e-6f);
  }
}

TEST(RigReferencePose, EulerAnglesTurnAboutFixedAxesInOrder) {
  const glm::vec3 v = FromEulerDegrees({90, 90, 0}) * glm::vec3(0, 1, 0);
  // X takes +Y to +Z, then Y takes +Z to +X.
  EXPECT_NEAR(v.x, 1.0f, 1e-6);
  EXPECT_NEAR(v.y, 0.0f, 1e-6);
  EXPECT_NEAR(v.z, 0.0f, 1e-6);
}

}  // namespace
}  // namespace furrow::rig
