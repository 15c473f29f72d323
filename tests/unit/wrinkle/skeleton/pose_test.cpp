// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/pose.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/wrinkle/test_characters.h"

namespace furrow::wrinkle {
namespace {

TEST(Transform, MatrixAppliesScaleThenRotationThenTranslation) {
  Transform transform;
  transform.translation = {10.0f, 0.0f, 0.0f};
  transform.rotation = AngleAxis(90.0f, {0.0f, 0.0f, 1.0f});
  transform.scale = {2.0f, 3.0f, 1.0f};
  const glm::vec4 moved = ToMatrix(transform) * glm::vec4(1.0f, 1.0f, 5.0f, 1.0f);
  // Scaled to (2, 3, 5), turned to (-3, 2, 5), moved to (7, 2, 5).
  EXPECT_NEAR(moved.x, 7.0f, 1e-5f);
  EXPECT_NEAR(moved.y, 2.0f, 1e-5f);
  EXPECT_NEAR(moved.z, 5.0f, 1e-5f);
}

TEST(Transform, IsValidAsksForFiniteAndUnit) {
  EXPECT_TRUE(IsValid(Transform()));
  Transform bad;
  bad.rotation.w = 0.9f;
  EXPECT_FALSE(IsValid(bad));
  bad = Transform();
  bad.translation.z = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(IsValid(bad));
  bad = Transform();
  bad.rotation.x = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(IsValid(bad));
}

class LocalToModelTest : public testing::Test {
 protected:
  LocalToModelJob Job() { return {.skeleton = &skeleton_, .local = pose_.joints, .model = model_}; }

  Skeleton skeleton_ = MakeBody(3);
  LocalPose pose_ = RestPose(skeleton_);
  std::vector<glm::mat4> model_ =
      std::vector<glm::mat4>(static_cast<std::size_t>(skeleton_.num_joints()), glm::mat4(-1.0f));
};

TEST_F(LocalToModelTest, ValidatesOneInputAtATime) {
  EXPECT_EQ(Job().Validate(), JobStatus::kOk);
  LocalToModelJob job = Job();
  job.skeleton = nullptr;
  EXPECT_EQ(job.Validate(), JobStatus::kNullPointer);
  job = Job();
  job.local = job.local.first(job.local.size() - 1);
  EXPECT_EQ(job.Validate(), JobStatus::kSizeMismatch);
  job = Job();
  job.model = job.model.first(job.model.size() - 1);
  EXPECT_EQ(job.Validate(), JobStatus::kSizeMismatch);
  pose_.joints[5].rotation.y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(Job().Validate(), JobStatus::kNonFinite);
}

TEST_F(LocalToModelTest, LeavesTheOutputAloneOnFailure) {
  pose_.joints.back().translation.x = std::numeric_limits<float>::infinity();
  EXPECT_EQ(Job().Run(), JobStatus::kNonFinite);
  for (const glm::mat4& matrix : model_) EXPECT_EQ(matrix, glm::mat4(-1.0f));
}

TEST_F(LocalToModelTest, GivesTheRestModelAtRest) {
  ASSERT_EQ(Job().Run(), JobStatus::kOk);
  for (std::size_t i = 0; i < model_.size(); ++i) EXPECT_EQ(model_[i], skeleton_.rest_model()[i]);
}

TEST_F(LocalToModelTest, CarriesChildrenAlong) {
  // The left leg turned forward about the hip by 90 degrees: shin at hip height, 0.45 in front.
  Turn(skeleton_, "thigh_l", AngleAxis(-90.0f, {1.0f, 0.0f, 0.0f}), &pose_);
  ASSERT_EQ(Job().Run(), JobStatus::kOk);
  const glm::vec3 shin(model_[skeleton_.Find("shin_l")][3]);
  EXPECT_LT(glm::distance(shin, glm::vec3(0.1f, 0.95f, 0.45f)), 1e-5f);
}

TEST_F(LocalToModelTest, RunsOnAnEmptySkeleton) {
  const Skeleton none;
  EXPECT_EQ((LocalToModelJob{.skeleton = &none}).Run(), JobStatus::kOk);
}

TEST(LocalPose, SetRestTakesJointsAndClearsBlendShapes) {
  LocalPose pose;
  pose.blend_shapes = {0.5f, 1.0f};
  const Skeleton skeleton = MakeBody();
  pose.SetRest(skeleton);
  EXPECT_EQ(pose.joints.size(), static_cast<std::size_t>(skeleton.num_joints()));
  EXPECT_EQ(pose.blend_shapes, (std::vector<float>{0.0f, 0.0f}));
}

}  // namespace
}  // namespace furrow::wrinkle
