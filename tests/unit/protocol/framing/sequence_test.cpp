// SPDX-License-Identifier: Apache-2.0
#include "protocol/framing/sequence.h"

#include <gtest/gtest.h>

namespace furrow::protocol {
namespace {

using enum SequenceStatus;

TEST(SequenceWindow, AcceptsNewerPosesAndCountsLostOnes) {
  SequenceWindow window;
  EXPECT_EQ(window.Accept(1, 5), kRestart);
  EXPECT_EQ(window.Accept(1, 6), kNewest);
  EXPECT_EQ(window.Accept(1, 10), kNewest);
  EXPECT_EQ(window.lost(), 3u);
  EXPECT_EQ(window.Accept(1, 8), kLate);
  EXPECT_EQ(window.lost(), 2u) << "8 came after all";
  EXPECT_EQ(window.Accept(1, 8), kDuplicate);
  EXPECT_EQ(window.Accept(1, 10), kDuplicate);
  EXPECT_EQ(window.Accept(1, 4), kLate) << "before the first: never expected";
  EXPECT_EQ(window.lost(), 2u);
}

TEST(SequenceWindow, GoesOnAfterAnotherWindow) {
  SequenceWindow window = SequenceWindow::After(7, 100);
  EXPECT_EQ(window.newest(), 100u);
  EXPECT_EQ(window.Accept(7, 100), SequenceStatus::kDuplicate);
  EXPECT_EQ(window.Accept(7, 99), SequenceStatus::kLate);
  EXPECT_EQ(window.Accept(7, 101), SequenceStatus::kNewest);
  EXPECT_EQ(window.lost(), 0u);
  EXPECT_EQ(window.Accept(8, 0), SequenceStatus::kRestart);
}

TEST(SequenceWindow, WrapsAround) {
  SequenceWindow window;
  EXPECT_EQ(window.Accept(1, 0xFFFFFFFEu), kRestart);
  EXPECT_EQ(window.Accept(1, 0xFFFFFFFFu), kNewest);
  EXPECT_EQ(window.Accept(1, 0), kNewest);
  EXPECT_EQ(window.Accept(1, 0xFFFFFFFFu), kDuplicate);
  EXPECT_EQ(window.Accept(1, 1), kNewest);
  EXPECT_EQ(window.lost(), 0u);
}

TEST(SequenceWindow, AcceptsARestartAndRejectsTheOldSession) {
  SequenceWindow window;
  EXPECT_EQ(window.Accept(1, 5000), kRestart);
  EXPECT_EQ(window.Accept(2, 0), kRestart);
  EXPECT_EQ(window.Accept(1, 5001), kOldSession);
  EXPECT_EQ(window.Accept(2, 1), kNewest);
  EXPECT_EQ(window.session(), 2u);
}

TEST(SequenceWindow, OldSequenceIsLateAndKeepsTheWindow) {
  SequenceWindow window;
  (void)window.Accept(1, 100'000);
  EXPECT_EQ(window.Accept(1, 0), kLate);
  EXPECT_EQ(window.newest(), 100'000u);
}

// Compares with a simple model: the set of all received sequences.
TEST(SequenceWindow, DetectsEveryDuplicateInTheWindow) {
  SequenceWindow window;
  std::vector<bool> seen(20'000);
  std::uint32_t newest = 0;
  std::uint32_t state = 12345;
  (void)window.Accept(1, 0);
  seen[0] = true;
  for (int i = 0; i < 8000; ++i) {
    state = state * 1664525u + 1013904223u;
    const std::uint32_t jump = (state >> 16) % 700;  // up to 695 back, up to 4 ahead
    const std::uint32_t sequence = newest + 4 < jump ? 0 : newest + 4 - jump;
    const SequenceStatus status = window.Accept(1, sequence);
    if (sequence > newest) {
      EXPECT_EQ(status, kNewest);
      newest = sequence;
    } else {
      EXPECT_EQ(status, seen[sequence] ? kDuplicate : kLate) << sequence;
    }
    seen[sequence] = true;
  }
  EXPECT_GT(newest, 10u);
}

}  // namespace
}  // namespace furrow::protocol
