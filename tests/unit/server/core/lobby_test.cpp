// SPDX-License-Identifier: Apache-2.0
#include "server/core/lobby.h"

#include <vector>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

TEST(Lobby, BoundsHowManyWait) {
  Lobby lobby;
  const Time now = FromSeconds(100);
  std::vector<Lobby::Stay> stays;
  for (int i = 0; i < Lobby::kPlaces; ++i) {
    stays.push_back(lobby.Enter(now));
    ASSERT_NE(stays.back(), nullptr) << i;
  }
  EXPECT_EQ(lobby.Enter(now + FromSeconds(1)), nullptr);
  stays.pop_back();
  EXPECT_NE(lobby.Enter(now + FromSeconds(1)), nullptr);
}

TEST(Lobby, BoundsHowManyComePerSecond) {
  Lobby lobby;
  int entered = 0;
  for (int i = 0; i < 10'000; ++i) {
    if (lobby.Enter(FromSeconds(100 + i * 1e-3)) != nullptr) ++entered;
  }
  EXPECT_NEAR(entered, 10 * Lobby::kPerSecond, Lobby::kPlaces + 1);
}

}  // namespace
}  // namespace furrow::server
