// SPDX-License-Identifier: Apache-2.0
#include "server/core/status_line.h"

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

TEST(StatusLine, ShowsRatesSinceTheLastLineAndOnlyNonZeroDrops) {
  Metrics metrics;
  StatusLine line(&metrics);
  metrics.Add(Counter::kPosesReceived, 60);
  metrics.Add(Counter::kWeightsSent, 180);
  EXPECT_EQ(line.Next(2, 3, FromSeconds(10)),
            "2 subjects, 3 subscriptions, 60 poses/s, 180 weights/s, 0 pictures/s");
  metrics.Add(Counter::kPosesReceived, 120);
  metrics.Add(Counter::kPosesLate, 4);
  EXPECT_EQ(line.Next(2, 3, FromSeconds(12)),
            "2 subjects, 3 subscriptions, 60 poses/s, 0 weights/s, 0 pictures/s; dropped: 4 late "
            "poses");
  EXPECT_EQ(line.Next(0, 1, FromSeconds(13)),
            "0 subjects, 1 subscription, 0 poses/s, 0 weights/s, 0 pictures/s");
}

}  // namespace
}  // namespace furrow::server
