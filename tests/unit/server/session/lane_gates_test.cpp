// SPDX-License-Identifier: Apache-2.0
#include "server/session/lane_gates.h"

#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

constexpr int kLanes = 3;
constexpr int kTurns = 2000;

TEST(LaneGates, WhoIsAloneIsAlone) {
  LaneGates gates(kLanes);
  std::array<int, kLanes> written{};  // by the lane's thread, and by whoever is alone
  std::atomic<int> inside = 0;
  std::vector<std::jthread> threads;
  for (int lane = 0; lane < kLanes; ++lane) {
    threads.emplace_back([&, lane] {
      for (int i = 0; i < kTurns; ++i) {
        gates.Enter(lane);
        ++inside;
        ++written[static_cast<std::size_t>(lane)];
        --inside;
        gates.Leave(lane);
        if (i % 7 != 0) continue;
        gates.EnterAlone();
        EXPECT_EQ(inside, 0);
        for (int& each : written) ++each;
        gates.LeaveAlone();
      }
    });
  }
  threads.clear();
  const int alone = kLanes * ((kTurns + 6) / 7);
  for (const int each : written) EXPECT_EQ(each, kTurns + alone);
}

TEST(LaneGates, LanesDoNotWaitForEachOther) {
  LaneGates gates(2);
  gates.Enter(0);
  std::jthread([&] {
    gates.Enter(1);
    gates.Leave(1);
  }).join();
  gates.Leave(0);
}

TEST(LaneGates, WhoWasAloneMayGoOnInItsLaneWhileOthersDo) {
  LaneGates gates(2);
  gates.EnterAlone();
  gates.LeaveAloneInto(0);
  std::jthread([&] {
    gates.Enter(1);
    gates.Leave(1);
  }).join();
  std::atomic<bool> was_alone = false;
  std::jthread other([&] {
    gates.EnterAlone();
    was_alone = true;
    gates.LeaveAlone();
  });
  EXPECT_FALSE(was_alone) << "while lane 0 is entered";
  gates.Leave(0);
  other.join();
  EXPECT_TRUE(was_alone);
}

// Two lanes of which one at least is entered at any moment: they would keep a third thread out.
TEST(LaneGates, BusyLanesLetOthersBeAlone) {
  LaneGates gates(2);
  std::atomic<bool> done = false;
  std::vector<std::jthread> busy;
  for (int lane = 0; lane < 2; ++lane) {
    busy.emplace_back([&, lane] {
      while (!done) {
        gates.Enter(lane);
        gates.Leave(lane);
      }
    });
  }
  for (int i = 0; i < 100; ++i) {
    gates.EnterAlone();
    gates.LeaveAlone();
  }
  done = true;
}

}  // namespace
}  // namespace furrow::server
