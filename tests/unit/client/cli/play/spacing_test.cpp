// SPDX-License-Identifier: Apache-2.0
#include "client/cli/play/spacing.h"

#include <gtest/gtest.h>

namespace furrow::cli {
namespace {

TEST(Spacing, ADelayThatStaysIsNoError) {
  Spacing spacing;
  EXPECT_EQ(spacing.mean_ms(), 0.0);
  for (int i = 0; i < 4; ++i) spacing.Sent(10'000 * i, 10'000 * i + 700);
  EXPECT_EQ(spacing.count(), 4);
  EXPECT_EQ(spacing.mean_ms(), 0.0);
  EXPECT_EQ(spacing.largest_ms(), 0.0);
}

TEST(Spacing, OneLatePoseIsTwoWrongDistances) {
  Spacing spacing;
  for (int i = 0; i < 5; ++i) spacing.Sent(10'000 * i, 10'000 * i + (i == 2 ? 3'000 : 0));
  EXPECT_DOUBLE_EQ(spacing.largest_ms(), 3.0);
  EXPECT_DOUBLE_EQ(spacing.mean_ms(), 1.5) << "two of four distances are off by 3 ms";
}

}  // namespace
}  // namespace furrow::cli
