// SPDX-License-Identifier: Apache-2.0
#include "server/shares/lobby.h"

#include <vector>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

TEST(Lobby, BoundsHowManyWait) {
  Lobby lobby;
  const Time now = FromSeconds(100);
  std::vector<Lobby::Stay> stays;
  for (int i = 0; i < Lobby::kPlaces; ++i) {
    stays.push_back(lobby.Enter("a", now));
    ASSERT_NE(stays.back(), nullptr) << i;
  }
  EXPECT_EQ(lobby.Enter("a", now + FromSeconds(1)), nullptr);
  stays.pop_back();
  EXPECT_NE(lobby.Enter("a", now + FromSeconds(1)), nullptr);
}

TEST(Lobby, BoundsHowManyComePerSecond) {
  Lobby lobby;
  int entered = 0;
  for (int i = 0; i < 10'000; ++i) {
    if (lobby.Enter("a", FromSeconds(100 + i * 1e-3)) != nullptr) ++entered;
  }
  EXPECT_NEAR(entered, 10 * Lobby::kPerSecond, Lobby::kPlaces + 1);
}

// A place that was made for one newcomer must not go to the next.
TEST(Lobby, NewcomersOfAHostQueue) {
  Lobby lobby;
  const Time now = FromSeconds(100);
  EXPECT_FALSE(lobby.HasQueue("a"));
  Lobby::Stay first = lobby.Enter("a", now);
  const Lobby::Stay second = lobby.Enter("a", now), other = lobby.Enter("b", now);
  ASSERT_TRUE(first != nullptr && second != nullptr && other != nullptr);
  EXPECT_TRUE(lobby.HasQueue("a"));
  EXPECT_TRUE(lobby.IsFirst("a", first));
  EXPECT_FALSE(lobby.IsFirst("a", second));
  EXPECT_TRUE(lobby.IsFirst("b", other));
  first.reset();
  EXPECT_TRUE(lobby.IsFirst("a", second));
}

TEST(Lobby, AHostMayHaveFewPlaces) {
  Lobby lobby(Lobby::kFewPlaces);
  std::vector<Lobby::Stay> stays;
  for (int i = 0; i < Lobby::kFewPlaces; ++i) {
    stays.push_back(lobby.Enter("a", FromSeconds(100)));
    ASSERT_NE(stays.back(), nullptr);
  }
  EXPECT_EQ(lobby.Enter("a", FromSeconds(100)), nullptr);
  EXPECT_NE(lobby.Enter("b", FromSeconds(100)), nullptr);
  stays.pop_back();
  EXPECT_NE(lobby.Enter("a", FromSeconds(100)), nullptr);
}

TEST(Lobby, TheQueueEndsWithTheLastStay) {
  Lobby lobby;
  Lobby::Stay stay = lobby.Enter("a", FromSeconds(100));
  const Lobby::Stay copy = stay;
  stay.reset();
  EXPECT_TRUE(lobby.HasQueue("a"));
  EXPECT_TRUE(lobby.IsFirst("a", copy));
  { const Lobby::Stay brief = lobby.Enter("b", FromSeconds(100)); }
  EXPECT_FALSE(lobby.HasQueue("b"));
}

}  // namespace
}  // namespace furrow::server
