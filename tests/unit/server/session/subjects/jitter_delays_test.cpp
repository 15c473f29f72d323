// SPDX-License-Identifier: Apache-2.0
#include "server/session/subjects/jitter_delays.h"

#include <chrono>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using std::chrono::milliseconds;

TEST(JitterDelays, TheLastRuleThatMatchesCounts) {
  const JitterDelays delays({{"*", 60.0}, {"phone-*,tablet", 100.0}, {"phone-0", 0.0}});
  EXPECT_TRUE(delays.any());
  EXPECT_EQ(delays.Of("ada"), milliseconds(60));
  EXPECT_EQ(delays.Of("phone-7"), milliseconds(100));
  EXPECT_EQ(delays.Of("tablet"), milliseconds(100));
  EXPECT_EQ(delays.Of("phone-0"), Time{0});
  EXPECT_FALSE(JitterDelays({}).any());
  EXPECT_FALSE(JitterDelays({{"*", 0.0}}).any());
}

}  // namespace
}  // namespace furrow::server
