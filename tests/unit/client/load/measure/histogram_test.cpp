// SPDX-License-Identifier: Apache-2.0
#include "client/load/measure/histogram.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

namespace furrow::load {
namespace {

// The exact percentile from a sorted list. `percentile` in whole hundredths.
std::int64_t Sorted(std::vector<std::int64_t> values, double percentile) {
  std::ranges::sort(values);
  const auto hundredths = static_cast<std::size_t>(std::llround(percentile * 100.0));
  const std::size_t rank = (hundredths * values.size() + 9'999) / 10'000;
  return values[std::max<std::size_t>(rank, 1) - 1];
}

TEST(Histogram, PercentilesEqualThoseOfSortingWithinOnePartInAThousand) {
  std::mt19937_64 random(7);
  std::lognormal_distribution<> latency(11.0, 1.7);  // median 60 us, with a long tail
  Histogram histogram;
  std::vector<std::int64_t> values;
  for (int i = 0; i < 20000; ++i) {
    values.push_back(std::llround(latency(random)));
    histogram.Record(values.back());
  }
  for (const double percentile : {0.0, 1.0, 25.0, 50.0, 90.0, 99.0, 99.9, 99.99, 100.0}) {
    const auto exact = static_cast<double>(Sorted(values, percentile));
    const auto told = static_cast<double>(histogram.Percentile(percentile));
    EXPECT_GE(told, exact) << percentile;
    EXPECT_LE(told, exact * (1.0 + 1.0 / 1024.0)) << percentile;
  }
  EXPECT_EQ(histogram.max(), Sorted(values, 100.0));
  EXPECT_EQ(histogram.min(), Sorted(values, 0.0));
}

TEST(Histogram, SmallValuesAreExact) {
  Histogram histogram;
  std::vector<std::int64_t> values;
  for (std::int64_t i = 0; i < 2048; ++i) {
    values.push_back(i * i % 2048);
    histogram.Record(values.back());
  }
  for (double percentile = 0.0; percentile <= 100.0; percentile += 0.5)
    EXPECT_EQ(histogram.Percentile(percentile), Sorted(values, percentile)) << percentile;
}

// In binary, 99.9% of 1,000 is slightly more than 999.
TEST(Histogram, AWholeRankIsNotRoundedUp) {
  Histogram histogram;
  for (std::int64_t i = 1; i <= 1000; ++i) histogram.Record(i);
  EXPECT_EQ(histogram.Percentile(99.9), 999);
  EXPECT_EQ(histogram.Percentile(99.0), 990);
  EXPECT_EQ(histogram.Percentile(99.91), 1000);
  EXPECT_EQ(histogram.Percentile(100.0), 1000);
  for (std::int64_t i = 1001; i <= 10000; ++i) histogram.Record(i);
  EXPECT_EQ(histogram.Percentile(99.9), 9990 | 7);  // the upper end of its cell
  EXPECT_EQ(histogram.Percentile(0.01), 1);
}

TEST(Histogram, CellsHaveNoGapsAndNoOverlaps) {
  EXPECT_EQ(Histogram::Cell(0), 0u);
  for (std::size_t cell = 0; cell < 40000; ++cell) {
    EXPECT_EQ(Histogram::Cell(Histogram::UpperEnd(cell)), cell);
    EXPECT_EQ(Histogram::Cell(Histogram::UpperEnd(cell) + 1), cell + 1);
  }
}

TEST(Histogram, AddEqualsRecordingAllValues) {
  Histogram a;
  Histogram b;
  Histogram both;
  for (std::int64_t i = 1; i < 3000; i += 7) {
    (i % 2 == 0 ? a : b).Record(i * i);
    both.Record(i * i);
  }
  a.Add(b);
  a.Add(Histogram());
  EXPECT_EQ(a.count(), both.count());
  for (const double percentile : {10.0, 50.0, 99.0, 100.0})
    EXPECT_EQ(a.Percentile(percentile), both.Percentile(percentile));
  EXPECT_EQ(a.min(), both.min());
  EXPECT_DOUBLE_EQ(a.Mean(), both.Mean());
}

TEST(Histogram, EmptyHistogramsAndNegativeValuesGiveZero) {
  Histogram histogram;
  EXPECT_EQ(histogram.Percentile(99.0), 0);
  EXPECT_EQ(histogram.Mean(), 0.0);
  histogram.Record(-5);
  EXPECT_EQ(histogram.max(), 0);
  EXPECT_EQ(histogram.count(), 1u);
}

// Each line holds value, share, count and 1/(1-share). The last line has no fourth column.
TEST(Histogram, HgrmCountsUpToTheTotal) {
  Histogram histogram;
  for (std::int64_t i = 1; i <= 1000; ++i) histogram.Record(i * 1000);
  std::ostringstream out;
  histogram.WriteHgrm(out, 1000.0);
  std::istringstream lines(out.str());
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "       Value     Percentile TotalCount 1/(1-Percentile)");
  std::getline(lines, line);
  double last_value = 0.0;
  std::uint64_t last_count = 0;
  int rows = 0;
  while (std::getline(lines, line) && line[0] != '#') {
    std::istringstream fields(line);
    double value = 0.0;
    double share = 0.0;
    std::uint64_t count = 0;
    ASSERT_TRUE(fields >> value >> share >> count) << line;
    EXPECT_GE(value, last_value);
    EXPECT_GT(count, last_count);
    EXPECT_NEAR(share, static_cast<double>(count) / 1000.0, 1e-9);
    EXPECT_NEAR(value, static_cast<double>(count), static_cast<double>(count) / 500.0);
    last_value = value;
    last_count = count;
    ++rows;
  }
  EXPECT_EQ(last_count, 1000u);
  EXPECT_NEAR(last_value, 1000.0, 1e-6);
  EXPECT_GT(rows, 20);
  EXPECT_NE(out.str().find("Total count    =         1000]"), std::string::npos);
}

}  // namespace
}  // namespace furrow::load
