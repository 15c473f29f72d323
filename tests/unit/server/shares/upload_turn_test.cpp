// SPDX-License-Identifier: Apache-2.0
#include "server/shares/upload_turn.h"

#include <string>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(UploadTurn, OneAtATime) {
  UploadTurn turns;
  auto first = turns.Begin("a", Time{0});
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(turns.Begin("a", Time{0}), nullptr);
  EXPECT_EQ(turns.Begin("b", Time{0}), nullptr);
  first.reset();
  EXPECT_NE(turns.Begin("a", Time{0}), nullptr) << "it asked before b did";
}

TEST(UploadTurn, ATurnOutlivesItsObject) {
  UploadTurn::Turn turn;
  {
    UploadTurn turns;
    turn = turns.Begin("a", Time{0});
  }
  EXPECT_NE(turn, nullptr);
}

// A host that asks without pause, also while it uploads, gets every second turn.
TEST(UploadTurn, AHostThatUploadsWithoutPauseLeavesOthersTheirTurn) {
  UploadTurn turns;
  int greedy = 0;
  int modest = 0;
  Time now{0};
  for (int i = 0; i < 10; ++i) {
    auto turn = turns.Begin("greedy", now);
    std::string holder = "greedy";
    if (turn == nullptr) {
      turn = turns.Begin("modest", now);
      holder = "modest";
    }
    ASSERT_NE(turn, nullptr);
    ++(holder == "greedy" ? greedy : modest);
    // Both ask again while the upload is under way.
    for (int again = 0; again < 5; ++again) {
      now += milliseconds(100);
      EXPECT_EQ(turns.Begin("greedy", now), nullptr);
      EXPECT_EQ(turns.Begin("modest", now), nullptr);
    }
    // The queue decides, whoever asks first.
    turn.reset();
  }
  EXPECT_EQ(greedy, 6);  // the first two, and then every second one
  EXPECT_EQ(modest, 4);
}

TEST(UploadTurn, AHostThatDoesNotComeBackKeepsNobodyWaiting) {
  UploadTurn turns;
  auto turn = turns.Begin("a", Time{0});
  EXPECT_EQ(turns.Begin("b", Time{0}), nullptr);
  turn.reset();
  EXPECT_EQ(turns.Begin("a", UploadTurn::kKept - milliseconds(1)), nullptr) << "b comes next";
  EXPECT_NE(turns.Begin("a", UploadTurn::kKept), nullptr);
}

TEST(UploadTurn, TheQueueIsBounded) {
  UploadTurn turns;
  auto turn = turns.Begin("a", Time{0});
  for (std::size_t i = 0; i < UploadTurn::kMostHosts; ++i) {
    EXPECT_EQ(turns.Begin("host " + std::to_string(i), Time{0}), nullptr);
  }
  EXPECT_EQ(turns.Begin("late", Time{0}), nullptr);
  turn.reset();
  EXPECT_EQ(turns.Begin("late", Time{1}), nullptr);
  EXPECT_NE(turns.Begin("host 0", Time{1}), nullptr);
}

}  // namespace
}  // namespace furrow::server
