// SPDX-License-Identifier: Apache-2.0
#include "client/load/measure/expected_weights.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/client/load/workload_testing.h"

namespace furrow::load {
namespace {

TEST(ExpectedWeights, DistanceIsTheLargestDifference) {
  const float a[] = {0.0f, 0.5f, 1.0f};
  const float b[] = {0.1f, 0.5f, 0.25f};
  EXPECT_FLOAT_EQ(Distance(a, b), 0.75f);
  EXPECT_TRUE(std::isinf(Distance(a, std::span(b).first(2))));
}

TEST(ExpectedWeights, IsNearComparesWithATolerance) {
  const float a[] = {0.0f, 0.5f, 1.0f};
  const float b[] = {0.1f, 0.5f, 0.25f};
  EXPECT_TRUE(IsNear(a, b, 0.75f));
  EXPECT_FALSE(IsNear(a, b, 0.74f));
  EXPECT_FALSE(IsNear(a, std::span(b).first(2), 1.0f));
  const float strange[] = {0.0f, std::numeric_limits<float>::quiet_NaN(), 1.0f};
  EXPECT_FALSE(IsNear(strange, a, 1.0f));
}

TEST(ExpectedWeights, FindReturnsThePlaceOfARow) {
  const Workload workload = MakePerformance();
  const Plan plan(workload.times, {.subjects = 4, .phases = 4, .rate = 0.0, .seconds = 0.7});
  const ExpectedWeights expected(workload, plan, [](double) { return true; });
  const auto row = expected.Row(2, 20);
  const auto place = expected.Find(row, 0.0f);
  ASSERT_TRUE(place);
  EXPECT_LE(Distance(expected.Row(place->phase, place->pose), row), 0.0f);
  std::vector<float> other(row.begin(), row.end());
  other[1] += 2.0f;
  EXPECT_FALSE(expected.Find(other, 1e-4f));
  EXPECT_FALSE(expected.Find(row.first(2), 1e-4f));
}

TEST(ExpectedWeights, SolvingCanBeCancelled) {
  const Workload workload = MakePerformance();
  const Plan plan(workload.times, {.subjects = 4, .phases = 4, .rate = 0.0, .seconds = 0.7});
  int asked = 0;
  const ExpectedWeights expected(workload, plan, [&](double) { return ++asked < 2; });
  EXPECT_TRUE(expected.interrupted());
  EXPECT_EQ(asked, 2);
}

}  // namespace
}  // namespace furrow::load
