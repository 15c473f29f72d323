// SPDX-License-Identifier: Apache-2.0
#include "client/net/arrival_clock.h"

#include <gtest/gtest.h>

namespace furrow::net {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kSteady = 5 * kSecond;
constexpr std::int64_t kWall = 1'700'000'000 * kSecond;

TEST(ArrivalClock, ConvertsAStampToTheSteadyClock) {
  ArrivalClock clock;
  clock.Set(kSteady, kWall);
  EXPECT_EQ(clock.FromWall(kWall - 20'000), kSteady - 20'000);
  clock.Set(kSteady + kSecond, kWall + kSecond);
  EXPECT_EQ(clock.FromWall(kWall + kSecond - 1), kSteady + kSecond - 1);
}

TEST(ArrivalClock, AnArrivalIsNeverAfterTheRead) {
  ArrivalClock clock;
  clock.Set(kSteady, kWall);
  EXPECT_EQ(clock.FromWall(kWall + 500), kSteady);
}

TEST(ArrivalClock, FollowsASlewedWallClock) {
  ArrivalClock clock;
  clock.Set(kSteady, kWall);
  clock.Set(kSteady + kSecond, kWall + kSecond + 400'000);
  EXPECT_EQ(clock.FromWall(kWall + kSecond + 400'000 - 30'000), kSteady + kSecond - 30'000);
  clock.Set(kSteady + 61 * kSecond, kWall + 61 * kSecond + 24'400'000);
  EXPECT_EQ(clock.FromWall(kWall + 61 * kSecond + 24'400'000 - 30'000),
            kSteady + 61 * kSecond - 30'000)
      << "a minute without datagrams";
}

TEST(ArrivalClock, IgnoresStampsFromBeforeAStepOfTheWallClock) {
  for (const std::int64_t step : {-3600 * kSecond, 3600 * kSecond}) {
    ArrivalClock clock;
    clock.Set(kSteady, kWall);
    clock.Set(kSteady + kSecond, kWall + kSecond + step);
    EXPECT_EQ(clock.FromWall(kWall + kSecond - 20'000), kSteady + kSecond) << step;
    clock.Set(kSteady + 2 * kSecond, kWall + 2 * kSecond + step);
    EXPECT_EQ(clock.FromWall(kWall + 2 * kSecond + step - 20'000), kSteady + 2 * kSecond - 20'000)
        << "later stamps are valid again";
  }
}

TEST(ArrivalClock, WithoutAStampTheArrivalIsTheTimeOfTheRead) {
  ArrivalClock clock;
  clock.Set(kSteady, kWall);
  msghdr bare{};
  EXPECT_EQ(clock.Arrival(&bare), kSteady);
}

}  // namespace
}  // namespace furrow::net
