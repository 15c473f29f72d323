// SPDX-License-Identifier: Apache-2.0
#include "client/cli/play/pacing_error.h"

#include <gtest/gtest.h>

namespace furrow::cli {
namespace {

TEST(PacingError, AConstantDelayIsNotAnError) {
  PacingError pacing;
  EXPECT_EQ(pacing.mean_ms(), 0.0);
  for (int i = 0; i < 4; ++i) pacing.Sent(10'000 * i, 10'000 * i + 700);
  EXPECT_EQ(pacing.count(), 4);
  EXPECT_EQ(pacing.mean_ms(), 0.0);
  EXPECT_EQ(pacing.largest_ms(), 0.0);
}

TEST(PacingError, OneLatePoseGivesTwoWrongIntervals) {
  PacingError pacing;
  for (int i = 0; i < 5; ++i) pacing.Sent(10'000 * i, 10'000 * i + (i == 2 ? 3'000 : 0));
  EXPECT_DOUBLE_EQ(pacing.largest_ms(), 3.0);
  EXPECT_DOUBLE_EQ(pacing.mean_ms(), 1.5) << "two of four intervals have an error of 3 ms";
}

}  // namespace
}  // namespace furrow::cli
