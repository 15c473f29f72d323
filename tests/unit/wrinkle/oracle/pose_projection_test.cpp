// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/oracle/pose_projection.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace furrow::wrinkle {
namespace {

const std::vector<glm::vec3> kDisplacement = {{0.0f, 3.0f, 0.0f}, {0.0f, 0.0f, 4.0f}};  // |d| = 5

float Along(const std::vector<glm::vec3>& moved, const std::vector<glm::vec3>& d, float square) {
  std::vector<glm::vec3> projection;
  for (const glm::vec3& point : d) projection.push_back(Projection(point, square));
  return ProjectionAlong(moved, projection);
}

TEST(Projection, IsZeroAtRestAndOneAtTheReferencePose) {
  const std::vector<glm::vec3> rest(2, glm::vec3(0.0f));
  EXPECT_EQ(Along(rest, kDisplacement, 25.0f), 0.0f);
  EXPECT_EQ(Along(kDisplacement, kDisplacement, 25.0f), 1.0f);
}

// The thesis divides by |d|: that would give 5 at the reference pose.
TEST(Projection, StacksPointsIntoOneVector) {
  const std::vector<glm::vec3> moved = {{9.0f, 1.0f, 0.0f}, {0.0f, -2.0f, 2.0f}};
  EXPECT_FLOAT_EQ(Along(moved, kDisplacement, 25.0f), (3.0f + 8.0f) / 25.0f);
  EXPECT_DOUBLE_EQ(Dot(moved, kDisplacement), 11.0);
  // (9, 1 - 1.5, 0) and (0, -2, 2 - 2)
  EXPECT_FLOAT_EQ(SquaredDistance(moved, kDisplacement, 0.5f), 81.0f + 0.25f + 4.0f);
}

TEST(Projection, WithoutDisplacementIsZero) {
  const std::vector<glm::vec3> none(2, glm::vec3(0.0f));
  EXPECT_EQ(Along(kDisplacement, none, 0.0f), 0.0f);
}

TEST(Falloff, IsAGaussianOfTheRelativeDistance) {
  EXPECT_EQ(Falloff(0.0f, 25.0f, 1.0f), 1.0f);
  EXPECT_NEAR(Falloff(25.0f, 25.0f, 1.0f), std::exp(-0.5f), 1e-6f);  // one |d| off, s = 1
  EXPECT_NEAR(Falloff(25.0f, 25.0f, 0.5f), std::exp(-2.0f), 1e-6f);
  EXPECT_EQ(Falloff(25.0f, 25.0f, 0.0f), 1.0f);  // none
  EXPECT_EQ(Falloff(25.0f, 0.0f, 1.0f), 1.0f);
}

}  // namespace
}  // namespace furrow::wrinkle
