// SPDX-License-Identifier: Apache-2.0
#include "client/load/compare/rate_search.h"

#include <gtest/gtest.h>

namespace furrow::load {
namespace {

TEST(RateSearch, FindsTheHighestSustainedRate) {
  for (const double truth : {1500.0, 9000.0, 33333.0, 250000.0}) {
    RateSearch search(1000.0, 400000.0, 1.05, 2);
    int probes = 0;
    for (; !search.done(); ++probes) search.Report(search.rate() <= truth);
    EXPECT_LE(search.best(), truth);
    EXPECT_GE(search.best(), truth / 1.05);
    EXPECT_LT(probes, 32);
  }
}

TEST(RateSearch, OneFailureDoesNotCount) {
  RateSearch search(1000.0, 400000.0, 1.05, 2);
  for (int probe = 0; !search.done(); ++probe)
    search.Report(search.rate() <= 20000.0 && probe % 3 != 1);
  EXPECT_LE(search.best(), 20000.0);
  EXPECT_GE(search.best(), 20000.0 / 1.05);
}

TEST(RateSearch, EndsAtTheLimit) {
  RateSearch search(1000.0, 5000.0, 1.05, 1);
  while (!search.done()) search.Report(true);
  EXPECT_EQ(search.best(), 5000.0);
}

TEST(RateSearch, SearchesBelowTheStartAndStopsNearZero) {
  RateSearch below(1000.0, 5000.0, 1.05, 1);
  while (!below.done()) below.Report(below.rate() <= 300.0);
  EXPECT_LE(below.best(), 300.0);
  EXPECT_GE(below.best(), 300.0 / 1.05);
  RateSearch nothing(1000.0, 5000.0, 1.05, 1);
  while (!nothing.done()) nothing.Report(false);
  EXPECT_EQ(nothing.best(), 0.0);
}

}  // namespace
}  // namespace furrow::load
