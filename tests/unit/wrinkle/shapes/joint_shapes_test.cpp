// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/shapes/joint_shapes.h"

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/wrinkle/test_characters.h"

namespace furrow::wrinkle {
namespace {

constexpr int kNumPoints = 12;
constexpr float kScale = 0.5f;  // the character is half as large as the stream's skeleton

// A head with a ring of joints, and a surface that has a point at each of their places. The
// stream's model space is turned by 90 degrees about X, as in files with Z up.
struct JointFace {
  explicit JointFace(std::vector<std::string> names) : shapes(std::move(names)) {
    std::vector<ModelJoint> joints = {{"hips", "", {}, {}}, {"head", "hips", {0, 1, 0}, {}}};
    std::mt19937 random(5);
    for (int i = 0; i < kNumPoints; ++i) {
      const float angle = 0.5f * static_cast<float>(i);
      const glm::vec3 place(std::cos(angle), 1.0f + std::sin(angle), 0.3f);
      joints.push_back({"face" + std::to_string(i), "head", place, {}});
      MovedSurface::Point point{kScale * (turn * place), {}};
      for (std::uint32_t shape = 0; shape < shapes.size(); ++shape) {
        point.deltas.push_back({shape, RandomVector(&random, 0.05f)});
      }
      surface.points.push_back(point);
    }
    skeleton = MakeSkeleton(joints, 3);
    moved.assign(static_cast<std::size_t>(skeleton.num_joints()), false);
    for (int i = 0; i < kNumPoints; ++i) {
      const int joint = skeleton.Find("face" + std::to_string(i));
      moved[static_cast<std::size_t>(joint)] = true;
      landmarks.push_back({joint, glm::vec3(0.0f), surface.points[i].position});
    }
  }
  [[nodiscard]] JointShapes Create() const {
    JointShapes::FaceShapes face{.count = shapes.size(), .close_contains_jaw = contains_jaw};
    for (std::uint32_t i = 0; i < shapes.size(); ++i) {
      if (shapes[i] == "jawOpen") face.jaw_open = i;
      if (shapes[i] == "mouthClose") face.mouth_close = i;
    }
    return JointShapes::Create(skeleton, moved, landmarks,
                               {.turn = turn, .scale = kScale, .reach = 0.02f}, surface, face);
  }
  // The pose in which the joints go where the shapes would take the surface.
  [[nodiscard]] LocalPose Pose(std::span<const float> weights) const {
    LocalPose pose = RestPose(skeleton);
    for (int i = 0; i < kNumPoints; ++i) {
      glm::vec3 motion(0.0f);
      for (const auto& [shape, delta] : surface.points[i].deltas) motion += weights[shape] * delta;
      Move(skeleton, "face" + std::to_string(i), glm::conjugate(turn) * motion / kScale, &pose);
    }
    return pose;
  }

  glm::quat turn = AngleAxis(-90.0f, {1, 0, 0});
  std::vector<std::string> shapes;
  bool contains_jaw = false;
  Skeleton skeleton;
  MovedSurface surface;
  std::vector<bool> moved;
  std::vector<FaceLandmark> landmarks;
};

TEST(JointShapes, FindsTheWeightsThatMovedTheJoints) {
  const JointFace face({"a", "b", "c", "d"});
  const JointShapes solver = face.Create();
  ASSERT_EQ(solver.num_landmarks(), kNumPoints);
  const std::vector<std::vector<float>> cases = {
      {0, 0, 0, 0}, {1, 0, 0, 0}, {0, 0.5f, 0, 0.25f}, {0.2f, 0.4f, 0.6f, 0.8f}};
  for (const auto& expected : cases) {
    std::vector<float> weights(4, 9.0f);
    ASSERT_EQ(solver.Run(face.Pose(expected).joints, weights), JobStatus::kOk);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(weights[i], expected[i], 0.03f) << i;
  }
}

TEST(JointShapes, WeightsStayWithinTheirRange) {
  const JointFace face({"a", "b"});
  const JointShapes solver = face.Create();
  std::vector<float> weights(2);
  const std::vector<float> wild = {3.0f, -2.0f};
  ASSERT_EQ(solver.Run(face.Pose(wild).joints, weights), JobStatus::kOk);
  EXPECT_EQ(weights, (std::vector<float>{1.0f, 0.0f}));
}

TEST(JointShapes, MotionOfTheHeadMovesNoShape) {
  const JointFace face({"a", "b"});
  LocalPose pose = RestPose(face.skeleton);
  Turn(face.skeleton, "head", AngleAxis(40.0f, {0, 1, 0}), &pose);
  Move(face.skeleton, "hips", {1, 2, 3}, &pose);
  std::vector<float> weights(2, 9.0f);
  ASSERT_EQ(face.Create().Run(pose.joints, weights), JobStatus::kOk);
  EXPECT_NEAR(weights[0], 0.0f, 1e-3f);
  EXPECT_NEAR(weights[1], 0.0f, 1e-3f);
}

TEST(JointShapes, MouthCloseIsAtMostJawOpen) {
  const JointFace face({"mouthClose", "jawOpen"});
  std::vector<float> weights(2);
  const std::vector<float> closed = {1.0f, 0.3f};
  ASSERT_EQ(face.Create().Run(face.Pose(closed).joints, weights), JobStatus::kOk);
  EXPECT_LE(weights[0], weights[1] + 1e-3f);
  EXPECT_GT(weights[0], 0.1f);
}

// The solution means what ARKit's shapes mean, although the shape itself opens the jaw.
TEST(JointShapes, AMouthCloseThatContainsTheJawIsSolvedWithoutIt) {
  JointFace face({"mouthClose", "jawOpen"});
  face.contains_jaw = true;
  for (auto& point : face.surface.points) {
    auto& deltas = point.deltas;
    deltas[0].delta += deltas[1].delta;
  }
  std::vector<float> weights(2);
  // The surface at jawOpen 0.7 and mouthClose 0.5 as ARKit means them.
  const std::vector<float> drawn = {0.5f, 0.2f};
  ASSERT_EQ(face.Create().Run(face.Pose(drawn).joints, weights), JobStatus::kOk);
  EXPECT_NEAR(weights[0], 0.5f, 0.03f);
  EXPECT_NEAR(weights[1], 0.7f, 0.03f);
}

TEST(JointShapes, FailuresChangeNothing) {
  const JointFace face({"a", "b"});
  const JointShapes solver = face.Create();
  std::vector<float> weights(2, 9.0f);
  LocalPose pose = RestPose(face.skeleton);
  const std::span<const Transform> joints(pose.joints);
  EXPECT_EQ(solver.Run(joints.first(3), weights), JobStatus::kSizeMismatch);
  EXPECT_EQ(solver.Run(joints, std::span<float>(weights).first(1)), JobStatus::kSizeMismatch);
  pose.joints.back().translation.x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(solver.Run(pose.joints, weights), JobStatus::kNonFinite);
  EXPECT_EQ(weights, (std::vector<float>{9.0f, 9.0f}));
}

TEST(JointShapes, AMarkForEachJointIsNeeded) {
  JointFace face({"a", "b"});
  face.moved.pop_back();
  EXPECT_TRUE(face.Create().empty());
}

TEST(JointShapes, LandmarksFarFromTheSurfaceAreIgnored) {
  JointFace face({"a", "b"});
  for (FaceLandmark& landmark : face.landmarks) landmark.on_target.z += 1.0f;
  EXPECT_TRUE(face.Create().empty());
}

}  // namespace
}  // namespace furrow::wrinkle
