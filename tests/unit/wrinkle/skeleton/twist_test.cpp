// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/twist.h"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/wrinkle/test_characters.h"

namespace furrow::wrinkle {
namespace {

// The same decomposition by another way: undo the shortest rotation that carries the axis to where
// `rotation` puts it, and measure how far what is left turns a vector across the axis.
float TwistByUndoingTheSwing(const glm::quat& rotation, const glm::vec3& axis) {
  const glm::vec3 carried = rotation * axis;
  const glm::vec3 half = glm::normalize(axis + carried);
  const glm::vec3 turn = glm::cross(axis, half);
  const glm::quat swing(glm::dot(axis, half), turn.x, turn.y, turn.z);
  const glm::quat left = glm::conjugate(swing) * rotation;
  const glm::vec3 across =
      glm::normalize(std::abs(axis.x) < 0.9f ? glm::cross(axis, glm::vec3(1, 0, 0))
                                             : glm::cross(axis, glm::vec3(0, 1, 0)));
  const glm::vec3 turned = left * across;
  return std::atan2(glm::dot(glm::cross(across, turned), axis), glm::dot(across, turned));
}

TEST(TwistAngle, MeasuresAPureTwist) {
  const glm::vec3 axis = glm::normalize(glm::vec3(1.0f, 2.0f, -0.5f));
  for (float degrees = -179.0f; degrees <= 179.0f; degrees += 1.0f) {
    const float angle = TwistAngle(AngleAxis(degrees, axis), axis);
    EXPECT_NEAR(glm::degrees(angle), degrees, 1e-3f);
  }
}

TEST(TwistAngle, SwingHasNoTwist) {
  const glm::vec3 axis(0.0f, 1.0f, 0.0f);
  for (float degrees = -170.0f; degrees <= 170.0f; degrees += 10.0f) {
    EXPECT_NEAR(TwistAngle(AngleAxis(degrees, {0.6f, 0.0f, 0.8f}), axis), 0.0f, 1e-6f);
  }
}

TEST(TwistAngle, AgreesWithAnIndependentConstruction) {
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    const glm::quat rotation = RandomRotation(&random);
    const glm::vec3 axis = RandomVector(&random, 1.0f);
    if (glm::dot(rotation * axis, axis) < -0.99f) continue;  // near a half turn: undefined
    const float difference = TwistAngle(rotation, axis) - TwistByUndoingTheSwing(rotation, axis);
    EXPECT_NEAR(std::sin(difference), 0.0f, 2e-4f);
    EXPECT_GT(std::cos(difference), 0.0f);
  }
}

TEST(TwistAngle, IsTheSameForBothSignsOfAQuaternion) {
  std::mt19937 random(6);
  for (int i = 0; i < 200; ++i) {
    const glm::quat rotation = RandomRotation(&random);
    const glm::vec3 axis = RandomVector(&random, 1.0f);
    EXPECT_EQ(TwistAngle(rotation, axis), TwistAngle(-rotation, axis));
  }
}

TEST(TwistAngle, IsZeroWhereItIsUndefined) {
  EXPECT_EQ(TwistAngle(glm::quat(0.0f, 1.0f, 0.0f, 0.0f), {0.0f, 1.0f, 0.0f}), 0.0f);
  EXPECT_EQ(TwistAngle(glm::quat(0.0f, 0.0f, 0.0f, 0.0f), {0.0f, 1.0f, 0.0f}), 0.0f);
}

}  // namespace
}  // namespace furrow::wrinkle
