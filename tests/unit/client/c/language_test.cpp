// SPDX-License-Identifier: Apache-2.0
// The programs in C99 and C++17 that use the headers are compiled as such, and run here.
#include <gtest/gtest.h>

#include "client/c/include/furrow/furrow.h"

extern "C" int FurrowTenLines(void);
int FurrowWrapper();

namespace {

TEST(Languages, AC99ProgramUsesTheHeader) { EXPECT_EQ(FurrowTenLines(), FURROW_NO_DATA); }

TEST(Languages, ACpp17ProgramUsesTheWrapper) { EXPECT_EQ(FurrowWrapper(), 0); }

}  // namespace
