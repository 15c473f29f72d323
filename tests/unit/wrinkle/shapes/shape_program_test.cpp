// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/shapes/shape_program.h"

#include <limits>

#include <gtest/gtest.h>

namespace furrow::wrinkle {
namespace {

const std::vector<std::string> kStream = {"jawOpen", "browInnerUp", "tongueOut"};
const std::vector<std::string> kFace = {"BrowInnerUp", "cheekPuff", "jawopen"};

TEST(ShapeProgram, ShapesTakeTheCoefficientsOfTheirNames) {
  const ShapeProgram program = ShapeProgram::ByName(kStream, kFace);
  EXPECT_FALSE(program.empty());
  std::vector<float> weights(3, 9.0f);
  ASSERT_EQ(program.Run(std::vector<float>{0.25f, 0.5f, 1.0f}, weights), JobStatus::kOk);
  EXPECT_EQ(weights, (std::vector<float>{0.5f, 0.0f, 0.25f}));
}

TEST(ShapeProgram, MissingCoefficientsAreZero) {
  const ShapeProgram program = ShapeProgram::ByName(kStream, kFace);
  std::vector<float> weights(3, 9.0f);
  ASSERT_EQ(program.Run(std::vector<float>{0.25f}, weights), JobStatus::kOk);
  EXPECT_EQ(weights, (std::vector<float>{0.0f, 0.0f, 0.25f}));
}

TEST(ShapeProgram, AStreamWithoutTheFacesNamesMovesNothing) {
  EXPECT_TRUE(ShapeProgram::ByName({}, kFace).empty());
  EXPECT_TRUE(ShapeProgram::ByName(kStream, {}).empty());
}

TEST(ShapeProgram, FailuresChangeNothing) {
  const ShapeProgram program = ShapeProgram::ByName(kStream, kFace);
  std::vector<float> weights(3, 9.0f);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(program.Run(std::vector<float>{nan}, weights), JobStatus::kNonFinite);
  EXPECT_EQ(weights, std::vector<float>(3, 9.0f));
  std::vector<float> two(2, 9.0f);
  EXPECT_EQ(program.Run(std::vector<float>{0.5f}, two), JobStatus::kSizeMismatch);
  EXPECT_EQ(two, std::vector<float>(2, 9.0f));
}

}  // namespace
}  // namespace furrow::wrinkle
