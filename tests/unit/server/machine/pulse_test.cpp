// SPDX-License-Identifier: Apache-2.0
#include "server/machine/pulse.h"

#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "server/net/clock.h"

namespace furrow::server {
namespace {

using std::chrono::seconds;

TEST(Pulse, TheLongestPauseCountsOnce) {
  std::atomic<Time> now = Time{0};
  Pulse pulse([&now] { return now.load(); });
  now = seconds(3);
  EXPECT_EQ(pulse.TakeLongestPause(), seconds(3));
  EXPECT_EQ(pulse.TakeLongestPause(), Time{0});
  now = seconds(4);
  EXPECT_EQ(pulse.TakeLongestPause(), seconds(1));
}

// The caller waits for its own reasons, as for a store that does not answer. However slow the
// computer is, the pause is shorter than that, because the thread has looked in between.
TEST(Pulse, ACallerThatWaitsMakesNoPause) {
  std::atomic<int> looks = 0;
  Pulse pulse([&looks] {
    ++looks;
    return ReadClock();
  });
  (void)pulse.TakeLongestPause();
  const Time start = ReadClock();
  for (const int before = looks; looks < before + 5;) std::this_thread::yield();
  EXPECT_LT(pulse.TakeLongestPause(), ReadClock() - start);
}

}  // namespace
}  // namespace furrow::server
