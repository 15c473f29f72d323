// SPDX-License-Identifier: Apache-2.0
#include "report/words.h"

#include <gtest/gtest.h>

namespace furrow::report {
namespace {

TEST(Counted, OnlyOneIsSingular) {
  EXPECT_EQ(Counted(0, "pose"), "0 poses");
  EXPECT_EQ(Counted(1, "pose"), "1 pose");
  EXPECT_EQ(Counted(21, "pose"), "21 poses");
  EXPECT_EQ(Counted(1, "search", "searches"), "1 search");
  EXPECT_EQ(Counted(2, "search", "searches"), "2 searches");
}

}  // namespace
}  // namespace furrow::report
