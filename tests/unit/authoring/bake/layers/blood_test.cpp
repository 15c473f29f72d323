// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/blood.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

std::vector<float> Sum(const std::vector<std::vector<float>>& poses,
                       const std::vector<float>& weights) {
  BloodSum sum(poses[0].size());
  for (const std::vector<float>& growth : poses) sum.Add(growth, weights);
  return sum.Take();
}

TEST(Blood, AmountIsIndependentOfTheArea) {
  const std::vector<float> blood = Sum({{1.0f, 0.8f, 1.25f}}, {1.0f, 1.0f, 1.0f});
  EXPECT_FLOAT_EQ(blood[0], 1.0f);
  EXPECT_NEAR(blood[1], 1.25f, 1e-5f);
  EXPECT_NEAR(blood[2], 0.8f, 1e-5f);
}

TEST(Blood, FollowsThePoseWeightWithinLimits) {
  const std::vector<float> blood = Sum({{0.8f, 0.8f, 0.0f, 9.0f}}, {0.0f, 0.5f, 1.0f, 1.0f});
  EXPECT_FLOAT_EQ(blood[0], 1.0f);
  EXPECT_NEAR(blood[1], std::sqrt(1.25f), 1e-5f);
  EXPECT_NEAR(blood[2], 2.0f, 1e-5f);
  EXPECT_NEAR(blood[3], 0.5f, 1e-5f);
}

TEST(Blood, LargestChangeOfSeveralPosesWins) {
  const std::vector<float> blood = Sum({{0.8f, 0.8f}, {1.0f / 0.8f, 1.05f}}, {1.0f, 1.0f});
  EXPECT_NEAR(blood[0], 1.0f, 0.01f);  // the two changes cancel
  EXPECT_NEAR(blood[1], 1.25f, 1e-3f);
}

TEST(Blood, TintGrowsWithTheAmount) {
  EXPECT_EQ(BloodTint(1.0f), glm::vec3(1.0f));
  glm::vec3 before = BloodTint(0.5f);
  for (float blood = 0.6f; blood <= 2.0f; blood += 0.1f) {
    const glm::vec3 tint = BloodTint(blood);
    for (int c = 0; c < 3; ++c) {
      EXPECT_LT(tint[c], before[c]);
      EXPECT_LE(tint[c], kBloodTintScale);
    }
    EXPECT_GT(tint.r / tint.g, before.r / before.g);  // redder
    before = tint;
  }
}

TEST(Blood, IsPressedOutOfFurrows) {
  EXPECT_FLOAT_EQ(BloodInFurrow(1.5f, 1.0f), 1.5f);
  EXPECT_LT(BloodInFurrow(1.5f, 0.5f), 1.5f);
  EXPECT_LT(BloodInFurrow(1.5f, 0.2f), BloodInFurrow(1.5f, 0.5f));
  EXPECT_GT(BloodInFurrow(1.5f, 0.0f), 0.0f);
}

// The pose makes the sheet narrower by a fifth.
TEST(Blood, BakedMapHasTheBloodOfItsPoses) {
  const character::Character sheet = toys::Wearing(toys::Sheet(0.1f, 0.1f, 10, 10));
  BakeOptions flat = toys::Exact();
  flat.skin.share = 0.0f;  // no folds
  const BakedMap map = toys::BakeFolds(sheet, {toys::Pose(toys::Squeeze(0.2f, 30.0f))}, flat);
  ASSERT_EQ(map.blood.size(), map.cavity.size());
  for (const float blood : map.blood) ASSERT_NEAR(blood, 1.25f, 1e-3f);
  const BakedMap folded =
      toys::BakeFolds(sheet, {toys::Pose(toys::Squeeze(0.2f, 30.0f))}, toys::Exact());
  for (std::size_t i = 0; i < folded.blood.size(); ++i) {
    ASSERT_NEAR(folded.blood[i], BloodInFurrow(1.25f, folded.cavity[i]), 1e-3f);
  }
}

}  // namespace
}  // namespace furrow::authoring
