// SPDX-License-Identifier: Apache-2.0
#include "server/tls/stranger_patience.h"

#include <chrono>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

constexpr Time kBegin = std::chrono::seconds(100);
constexpr Time kTick = std::chrono::milliseconds(50);

TEST(StrangerPatience, NobodyGivesWayForNothing) {
  StrangerPatience patience(kBegin);
  EXPECT_FALSE(patience.IsOver(kBegin + std::chrono::hours(1), 0, /*is_wanted=*/false));
  EXPECT_TRUE(patience.IsOver(kBegin + std::chrono::hours(1), 0, /*is_wanted=*/true));
}

TEST(StrangerPatience, ASilentStrangerGivesWaySoon) {
  StrangerPatience patience(kBegin);
  EXPECT_FALSE(patience.IsOver(kBegin + StrangerPatience::kSilence - Time(1), 3000, true));
  EXPECT_TRUE(patience.IsOver(kBegin + StrangerPatience::kSilence, 3000, true));
}

TEST(StrangerPatience, ItBeginsAgainAfterTheHandshake) {
  StrangerPatience patience(kBegin);
  patience.Restart(kBegin + StrangerPatience::kSilence);
  EXPECT_FALSE(patience.IsOver(kBegin + StrangerPatience::kSilence, 3000, true));
  EXPECT_TRUE(patience.IsOver(kBegin + 2 * StrangerPatience::kSilence, 3000, true));
}

TEST(StrangerPatience, AClientThatReceivesAPageHasMoreTime) {
  StrangerPatience patience(kBegin);
  std::uint64_t received = 0;
  Time now = kBegin;
  for (; now < kBegin + kHandshakeDeadline; now += kTick) {
    received += StrangerPatience::kProgressBytes / 8;
    ASSERT_FALSE(patience.IsOver(now, received, true)) << (now - kBegin).count();
  }
  EXPECT_TRUE(patience.IsOver(now, received, true)) << "but not for ever";
}

TEST(StrangerPatience, AClientThatReadsSlowlyHasNot) {
  StrangerPatience patience(kBegin);
  std::uint64_t received = 0;
  Time now = kBegin;
  while (!patience.IsOver(now, received, true)) {
    received += StrangerPatience::kProgressBytes / 16;
    now += kTick;
  }
  EXPECT_EQ(now, kBegin + StrangerPatience::kSilence);
}

}  // namespace
}  // namespace furrow::server
