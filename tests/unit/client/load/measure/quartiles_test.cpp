// SPDX-License-Identifier: Apache-2.0
#include "client/load/measure/quartiles.h"

#include <gtest/gtest.h>

namespace furrow::load {
namespace {

TEST(Quartiles, AreInterpolated) {
  const Quartiles odd = QuartilesOf({5.0, 1.0, 4.0, 2.0, 3.0});
  EXPECT_DOUBLE_EQ(odd.median, 3.0);
  EXPECT_DOUBLE_EQ(odd.low, 2.0);
  EXPECT_DOUBLE_EQ(odd.high, 4.0);
  const Quartiles even = QuartilesOf({10.0, 40.0, 20.0, 30.0});
  EXPECT_DOUBLE_EQ(even.median, 25.0);
  EXPECT_DOUBLE_EQ(even.low, 17.5);
  EXPECT_DOUBLE_EQ(even.high, 32.5);
  const Quartiles one = QuartilesOf({7.0});
  EXPECT_DOUBLE_EQ(one.low, 7.0);
  EXPECT_DOUBLE_EQ(one.high, 7.0);
}

TEST(Quartiles, RatiosPairTheValuesOfARound) {
  const std::vector<std::optional<double>> a = {2.0, std::nullopt, 6.0, 8.0, 9.0};
  const std::vector<std::optional<double>> b = {1.0, 1.0, 3.0, 0.0};
  EXPECT_EQ(Ratios(a, b), (std::vector<double>{2.0, 2.0}));
  EXPECT_EQ(Measured(a), (std::vector<double>{2.0, 6.0, 8.0, 9.0}));
  EXPECT_TRUE(Ratios(a, {}).empty());
}

}  // namespace
}  // namespace furrow::load
