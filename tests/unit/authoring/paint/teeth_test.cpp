// SPDX-License-Identifier: Apache-2.0
#include "authoring/paint/teeth.h"

#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

const ToothArch kUpper{true, {1.0f, 20.0f, 9.0f}, 2.75f, 4.2f, 0.8f};
const ToothArch kLower{false, {1.0f, 20.0f, 9.0f}, 2.75f, 4.2f, 0.8f};

TEST(Teeth, StandOnTheArch) {
  for (const ToothArch& arch : {kUpper, kLower}) {
    for (const glm::vec3& p : MakeToothRow(arch).positions) {
      const glm::vec3 from = p - arch.front;
      const float angle =
          std::hypot(from.x / arch.half_width, (from.z + arch.half_depth) / arch.half_depth);
      EXPECT_NEAR(angle, 1.0f, 0.08f);  // on the ellipse; crowns and gums protrude by millimetres
    }
  }
}

TEST(Teeth, AreTheSameOnBothSides) {
  const ToothRow row = MakeToothRow(kUpper);
  const std::size_t column = 8;  // points from the edge of the crown to the top of the gum
  ASSERT_EQ(row.positions.size() % column, 0u);
  const std::size_t last = row.positions.size() / column - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    for (std::size_t r = 0; r < column; ++r) {
      const glm::vec3 a = row.positions[i * column + r] - kUpper.front;
      const glm::vec3 b = row.positions[(last - i) * column + r] - kUpper.front;
      EXPECT_LT(glm::distance(a, b * glm::vec3(-1, 1, 1)), 1e-4f);
    }
  }
}

TEST(Teeth, FaceOutwardsAndAreSeparateInThePicture) {
  for (const ToothArch& arch : {kUpper, kLower}) {
    const ToothRow row = MakeToothRow(arch);
    ASSERT_EQ(row.quads.size() % 4, 0u);
    int outward = 0, inward = 0;
    for (std::size_t i = 0; i < row.quads.size(); i += 4) {
      const glm::vec3 a = row.positions[row.quads[i]], b = row.positions[row.quads[i + 1]],
                      c = row.positions[row.quads[i + 2]];
      const glm::vec3 out = (a - arch.front) * glm::vec3(1, 0, 1) + glm::vec3(0, 0, 4.2f);
      (glm::dot(glm::cross(b - a, c - a), out) > 0.0f ? outward : inward)++;
    }
    EXPECT_GT(outward, 9 * inward);  // surfaces under the edge of a crown face down
    for (const glm::vec2& uv : row.uvs) EXPECT_TRUE(arch.upper ? uv.y < 0.5f : uv.y > 0.5f);
  }
}

TEST(Teeth, GumsAreRedAndOldTeethAreYellow) {
  constexpr int kSize = 256;
  const character::Picture young = PaintTeeth(0.0f, kSize), old = PaintTeeth(1.0f, kSize);
  const auto at = [](const character::Picture& picture, float u, float v) {
    const auto x = static_cast<std::size_t>(u * kSize), y = static_cast<std::size_t>(v * kSize);
    return &picture.pixels[(y * kSize + x) * 3];
  };
  const std::uint8_t* crown = at(young, 0.55f, 0.40f);
  const std::uint8_t* gum = at(young, 0.55f, 0.05f);
  EXPECT_LT(crown[0] - crown[1], 20);
  EXPECT_GT(gum[0] - gum[1], 60);
  const std::uint8_t* aged = at(old, 0.55f, 0.40f);
  EXPECT_GT(aged[0] - aged[2], crown[0] - crown[2] + 10);
  // The gap between two teeth is darker than both teeth.
  EXPECT_LT(at(young, 0.5f, 0.40f)[0], crown[0] - 30);
}

}  // namespace
}  // namespace furrow::authoring
