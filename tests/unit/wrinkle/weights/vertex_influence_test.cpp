// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/weights/vertex_influence.h"

#include <gtest/gtest.h>

namespace furrow::wrinkle {
namespace {

TEST(Lambda, GivesTheWorkedValues) {
  EXPECT_EQ(Lambda(LambdaMode::kBinary, 0.0f, 0.25f), 0.0f);
  EXPECT_EQ(Lambda(LambdaMode::kBinary, 1e-6f, 0.25f), 1.0f);  // the thesis's seam
  EXPECT_EQ(Lambda(LambdaMode::kSmooth, 0.0f, 0.25f), 0.0f);
  EXPECT_LT(Lambda(LambdaMode::kSmooth, 1e-6f, 0.25f), 1e-9f);
  EXPECT_FLOAT_EQ(Lambda(LambdaMode::kSmooth, 0.125f, 0.25f), 0.5f);
  EXPECT_EQ(Lambda(LambdaMode::kSmooth, 0.25f, 0.25f), 1.0f);
  EXPECT_EQ(Lambda(LambdaMode::kSmooth, 1.0f, 0.25f), 1.0f);
  EXPECT_EQ(Lambda(LambdaMode::kLinear, 0.3f, 0.25f), 0.3f);
}

TEST(VertexInfluence, SumsOverTheJointsThatSkinTheVertex) {
  // Three joints, two maps, joint-major.
  const std::vector<float> influences = {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.9f};
  const std::vector<std::uint16_t> joints = {2, 0};
  const std::vector<float> skin_weights = {0.75f, 0.25f};
  const auto at = [&](int map, LambdaMode mode) {
    return VertexInfluence(joints, skin_weights, influences, 2, map, mode, 0.5f);
  };
  EXPECT_NEAR(at(0, LambdaMode::kLinear), 0.75f * 0.5f + 0.25f * 0.1f, 1e-6f);
  EXPECT_NEAR(at(0, LambdaMode::kBinary), 0.6f, 1e-6f);
  EXPECT_NEAR(at(0, LambdaMode::kSmooth), 0.5f + 0.5f * 0.1f, 1e-6f);
  EXPECT_EQ(at(1, LambdaMode::kBinary), 1.0f);  // 0.9 + 0.2, clamped
}

TEST(VertexInfluence, WithoutJointsIsZero) {
  const std::vector<float> influences = {1.0f};
  EXPECT_EQ(VertexInfluence({}, {}, influences, 1, 0, LambdaMode::kBinary, 0.25f), 0.0f);
}

}  // namespace
}  // namespace furrow::wrinkle
