// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/transform.h"

#include <cmath>

#include <gtest/gtest.h>

namespace furrow::gltf {
namespace {

void ExpectNear(const glm::mat4& a, const glm::mat4& b) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) EXPECT_NEAR(a[column][row], b[column][row], 1e-5f);
  }
}

TEST(Decompose, InvertsToMatrix) {
  for (const glm::vec3 scale : {glm::vec3(1), glm::vec3(2, 0.5f, 3), glm::vec3(-1, 1, 1)}) {
    const Transform transform{
        {1, -2, 3}, glm::normalize(glm::quat(0.3f, -0.5f, 0.7f, 0.1f)), scale};
    const glm::mat4 matrix = ToMatrix(transform);
    const Decomposition parts = Decompose(glm::dmat4(matrix));
    EXPECT_FALSE(parts.has_shear);
    EXPECT_FALSE(parts.is_flat);
    ExpectNear(ToMatrix(parts.transform), matrix);
  }
}

TEST(Decompose, MirrorsAlongX) {
  glm::dmat4 matrix(1.0);
  matrix[2][2] = -1.0;
  const Decomposition parts = Decompose(matrix);
  EXPECT_LT(parts.transform.scale.x, 0.0f);
  ExpectNear(ToMatrix(parts.transform), glm::mat4(matrix));
}

TEST(Decompose, ReportsShearAndStaysAUnitRotation) {
  for (const double shear : {0.002, 0.5, 100.0, -100.0}) {
    glm::dmat4 matrix(1.0);
    matrix[1][0] = shear;
    const Decomposition parts = Decompose(matrix);
    EXPECT_TRUE(parts.has_shear) << shear;
    EXPECT_NEAR(glm::length(parts.transform.rotation), 1.0f, 1e-5f) << shear;
    EXPECT_NEAR(parts.transform.scale.y, std::sqrt(1.0 + shear * shear), 1e-3) << shear;
  }
  glm::dmat4 rounded(1.0);
  rounded[1][0] = 1e-4;
  EXPECT_FALSE(Decompose(rounded).has_shear);
}

TEST(Decompose, KeepsFlatAxesAsScale) {
  const glm::quat turn = glm::normalize(glm::quat(0.3f, -0.5f, 0.7f, 0.1f));
  for (const glm::vec3 scale :
       {glm::vec3(0, 1, 2), glm::vec3(1, 0, 2), glm::vec3(0, 0, 2), glm::vec3(0)}) {
    const glm::mat4 matrix = ToMatrix({{1, 2, 3}, turn, scale});
    const Decomposition parts = Decompose(glm::dmat4(matrix));
    EXPECT_TRUE(parts.is_flat);
    EXPECT_NEAR(glm::length(parts.transform.rotation), 1.0f, 1e-5f);
    ExpectNear(ToMatrix(parts.transform), matrix);
  }
}

}  // namespace
}  // namespace furrow::gltf
