// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/packet/replay_window.h"

#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "tests/unit/protocol/secure/secure_testing.h"

namespace furrow::protocol::secure {
namespace {

using Answer = ReplayWindow::Answer;

bool Take(ReplayWindow& window, std::uint64_t counter) {
  if (window.Check(counter) != Answer::kNew) return false;
  window.Mark(counter);
  return true;
}

TEST(ReplayWindow, TheFirstCounterMayBeAny) {
  for (const std::uint64_t first : {std::uint64_t{0}, std::uint64_t{5}, ~std::uint64_t{0}}) {
    ReplayWindow window;
    EXPECT_TRUE(Take(window, first));
    EXPECT_EQ(window.Check(first), Answer::kDuplicate);
  }
}

TEST(ReplayWindow, HasExactlyTheStatedSize) {
  ReplayWindow window;
  EXPECT_TRUE(Take(window, 5'000));
  EXPECT_EQ(window.Check(5'000 - 1'023), Answer::kNew);
  EXPECT_EQ(window.Check(5'000 - 1'024), Answer::kTooOld);
  EXPECT_EQ(window.Check(0), Answer::kTooOld);
}

TEST(ReplayWindow, CheckingMovesNothing) {
  ReplayWindow window;
  EXPECT_TRUE(Take(window, 10));
  EXPECT_EQ(window.Check(std::numeric_limits<std::uint64_t>::max()), Answer::kNew);
  EXPECT_EQ(window.Check(9), Answer::kNew);
}

// Adding the size to a counter would overflow here, as in a fault of an earlier protocol.
TEST(ReplayWindow, WorksAtTheEndOfTheCounters) {
  constexpr std::uint64_t kLast = std::numeric_limits<std::uint64_t>::max();
  ReplayWindow window;
  EXPECT_TRUE(Take(window, kLast - 1));
  EXPECT_EQ(window.Check(kLast - 1), Answer::kDuplicate);
  EXPECT_TRUE(Take(window, kLast - 1'024));
  EXPECT_EQ(window.Check(kLast - 1'025), Answer::kTooOld);
  EXPECT_EQ(window.Check(3), Answer::kTooOld);
  EXPECT_TRUE(Take(window, kLast));
  EXPECT_EQ(window.Check(kLast - 1'024), Answer::kTooOld);
}

// Against a set that remembers everything.
TEST(ReplayWindow, AgreesWithASet) {
  test::RepeatableRandom random;
  for (int round = 0; round < 40; ++round) {
    ReplayWindow window;
    std::set<std::uint64_t> seen;
    std::uint64_t newest = 1'000'000 + random.Below(3'000);
    for (int i = 0; i < 2'000; ++i) {
      const std::uint64_t spread = round % 2 == 0 ? 1'500 : 100;
      std::uint64_t counter = newest + random.Below(spread) - spread * 3 / 4;
      if (random.Below(200) == 0) counter += 900 + random.Below(400);
      const bool too_old = !seen.empty() && counter < *seen.rbegin() &&
                           *seen.rbegin() - counter >= ReplayWindow::kSize;
      const bool is_new = !too_old && seen.insert(counter).second;
      ASSERT_EQ(Take(window, counter), is_new) << round << " " << counter;
      newest = *seen.rbegin();
    }
  }
}

}  // namespace
}  // namespace furrow::protocol::secure
