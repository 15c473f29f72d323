// SPDX-License-Identifier: Apache-2.0
#include "server/tls/stranger_patience.h"

#include <chrono>
#include <cstdint>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using std::chrono::milliseconds;

constexpr Time kBegin = std::chrono::seconds(100);
constexpr Time kTick = milliseconds(50);

// The time after which a stranger that others want gives way, if it receives this many bytes per
// second.
Time PatienceAt(std::uint64_t rate, Time round_trip = Time(0)) {
  StrangerPatience patience(kBegin);
  for (Time now = kBegin;; now += kTick) {
    const auto ms = static_cast<std::uint64_t>((now - kBegin) / milliseconds(1));
    if (patience.IsOver(now, {rate * ms / 1000, round_trip}, true)) return now - kBegin;
  }
}

TEST(StrangerPatience, ASilentStrangerGivesWaySoon) {
  StrangerPatience patience(kBegin);
  EXPECT_FALSE(patience.IsOver(kBegin + StrangerPatience::kSilence - Time(1), {3000}, true));
  EXPECT_TRUE(patience.IsOver(kBegin + StrangerPatience::kSilence, {3000}, true));
}

TEST(StrangerPatience, LongRoundTripsHaveMoreTime) {
  EXPECT_EQ(PatienceAt(0), StrangerPatience::kSilence);
  EXPECT_EQ(PatienceAt(0, milliseconds(75)), StrangerPatience::kSilence);
  EXPECT_EQ(PatienceAt(0, milliseconds(200)), milliseconds(1000));
  EXPECT_EQ(PatienceAt(0, milliseconds(600)), StrangerPatience::kMostSilence);
  EXPECT_EQ(PatienceAt(0, std::chrono::seconds(30)), StrangerPatience::kMostSilence);
}

// A satellite link, and others wait all the time: the answer to the handshake, the request, and the
// beginning of the reply take 600 ms each.
TEST(StrangerPatience, AnHonestClientFarAwayFinishes) {
  StrangerPatience patience(kBegin);
  Time now = kBegin;
  std::uint64_t bytes = 500;
  const auto survives = [&](Time time) {
    for (const Time end = now + time; now < end; now += kTick) {
      if (patience.IsOver(now, {bytes, milliseconds(600)}, true)) return false;
    }
    return true;
  };
  ASSERT_TRUE(survives(milliseconds(600)));
  bytes += 3000;
  patience.Restart(now);  // the handshake is over
  ASSERT_TRUE(survives(milliseconds(600)));
  patience.Restart(now);  // the request has arrived
  ASSERT_TRUE(survives(milliseconds(600)));
  for (int flights = 0; flights < 6; ++flights) {
    bytes += 30'000;
    ASSERT_TRUE(survives(milliseconds(600))) << flights;
  }
}

TEST(StrangerPatience, TimeCountsFromWhenOthersWait) {
  StrangerPatience patience(kBegin);
  Time now = kBegin;
  for (; now < kBegin + std::chrono::hours(1); now += std::chrono::seconds(1)) {
    ASSERT_FALSE(patience.IsOver(now, {3000}, false));
  }
  EXPECT_FALSE(patience.IsOver(now, {3000}, false));
  EXPECT_FALSE(patience.IsOver(now + kTick, {3000}, true));
  EXPECT_FALSE(patience.IsOver(now + StrangerPatience::kSilence - Time(1), {3000}, true));
  EXPECT_TRUE(patience.IsOver(now + StrangerPatience::kSilence, {3000}, true));
}

// As a page of 174 kB at 40 kB/s, in the middle of which a neighbour arrives.
TEST(StrangerPatience, AReplyThatGoesOnIsNotCut) {
  StrangerPatience patience(kBegin);
  std::uint64_t bytes = 0;
  Time now = kBegin + std::chrono::seconds(6);
  EXPECT_FALSE(patience.IsOver(now, {bytes}, false));
  for (; bytes < 174'000; now += kTick) {
    bytes += 2000;
    ASSERT_FALSE(patience.IsOver(now, {bytes}, /*is_wanted=*/bytes > 80'000));
  }
}

TEST(StrangerPatience, EachStepHasItsTime) {
  StrangerPatience patience(kBegin);
  patience.Restart(kBegin + StrangerPatience::kSilence);
  EXPECT_FALSE(patience.IsOver(kBegin + StrangerPatience::kSilence, {3000}, true));
  EXPECT_TRUE(patience.IsOver(kBegin + 2 * StrangerPatience::kSilence, {3000}, true));
}

TEST(StrangerPatience, AClientThatReceivesAPageHasMoreTime) {
  EXPECT_EQ(PatienceAt(StrangerPatience::kLeastRate), StrangerPatience::kMostPatience);
  EXPECT_EQ(PatienceAt(1'000'000), StrangerPatience::kMostPatience) << "but not for ever";
  EXPECT_EQ(PatienceAt(StrangerPatience::kLeastRate - 1000), StrangerPatience::kPatience);
  EXPECT_EQ(PatienceAt(StrangerPatience::kLeastRate / 4), StrangerPatience::kSilence)
      << "a client that reads slowly to stay";
}

// Old bytes do not make a client fast.
TEST(StrangerPatience, TheRateCountsFromTheLastStep) {
  StrangerPatience patience(kBegin);
  EXPECT_FALSE(patience.IsOver(kBegin, {10'000'000}, false));
  Time now = kBegin;
  std::uint64_t bytes = 10'000'000;
  while (!patience.IsOver(now, {bytes}, true)) {
    now += kTick;
    bytes += 600;
  }
  EXPECT_EQ(now - kBegin, StrangerPatience::kPatience);
}

}  // namespace
}  // namespace furrow::server
