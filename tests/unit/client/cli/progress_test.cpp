// SPDX-License-Identifier: Apache-2.0
#include "client/cli/progress.h"

#include <array>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

namespace furrow::cli {
namespace {

// What goes to standard error while it is `file`; both ends are closed afterwards.
template <class Action>
std::string WrittenTo(int file, int reading_end, const Action& action) {
  std::fflush(stderr);
  const int before = dup(STDERR_FILENO);
  dup2(file, STDERR_FILENO);
  action();
  std::fflush(stderr);
  dup2(before, STDERR_FILENO);
  close(before);
  std::string text;
  std::array<char, 4096> bytes;
  // A terminal ends with an error once nobody holds its other end, a pipe with nothing.
  close(file);
  for (ssize_t got = 0; (got = read(reading_end, bytes.data(), bytes.size())) > 0;)
    text.append(bytes.data(), static_cast<std::size_t>(got));
  close(reading_end);
  return text;
}

void HalfWay() {
  Progress progress("reading", 10);
  progress.Set(5);
  progress.Set(5);
}

TEST(Progress, IsDrawnOnATerminalOnceAPercentAndWiped) {
  int ours = -1;
  int terminal = -1;
  ASSERT_EQ(openpty(&ours, &terminal, nullptr, nullptr, nullptr), 0);
  const std::string half(16, '#');
  EXPECT_EQ(WrittenTo(terminal, ours, HalfWay),
            "\rreading [" + half + std::string(16, ' ') + "]  50%\r\033[K");
}

TEST(Progress, IsSilentInAPipe) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  EXPECT_EQ(WrittenTo(ends[1], ends[0], HalfWay), "");
}

}  // namespace
}  // namespace furrow::cli
