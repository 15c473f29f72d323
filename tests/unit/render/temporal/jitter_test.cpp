// SPDX-License-Identifier: Apache-2.0
#include "render/temporal/jitter.h"

#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace furrow::render {
namespace {

TEST(Jitter, StaysInThePixelAndIsCentred) {
  for (const float scale : {0.5f, 0.7f, 1.0f}) {
    glm::vec2 sum(0.0f);
    constexpr int kMany = 1000;
    for (int number = 0; number < kMany; ++number) {
      const glm::vec2 jitter = Jitter(number, scale);
      ASSERT_GE(jitter.x, -0.5f);
      ASSERT_LT(jitter.x, 0.5f);
      ASSERT_GE(jitter.y, -0.5f);
      ASSERT_LT(jitter.y, 0.5f);
      sum += jitter;
    }
    EXPECT_NEAR(sum.x / kMany, 0.0f, 0.08f) << scale;
    EXPECT_NEAR(sum.y / kMany, 0.0f, 0.08f) << scale;
  }
}

// At half the size, each drawn pixel covers four of the picture.
TEST(Jitter, ReachesEveryPixelOfThePicture) {
  std::set<std::pair<bool, bool>> quarters;
  for (int number = 0; number < 8; ++number) {
    const glm::vec2 jitter = Jitter(number, 0.5f);
    quarters.insert({jitter.x < 0.0f, jitter.y < 0.0f});
  }
  EXPECT_EQ(quarters.size(), 4u);
}

TEST(Jitter, SmallerPicturesTakeLongerUntilItRepeats) {
  const auto period = [](float scale) {
    int number = 1;
    while (Jitter(number, scale) != Jitter(0, scale)) ++number;
    return number;
  };
  EXPECT_EQ(period(1.0f), 8);
  EXPECT_EQ(period(0.5f), 32);
}

}  // namespace
}  // namespace furrow::render
