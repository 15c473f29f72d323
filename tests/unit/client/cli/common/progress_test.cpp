// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/progress.h"

#include <array>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

namespace furrow::cli {
namespace {

// Redirects standard error to `file` during `action` and returns what was written. Closes both
// ends.
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
  // Reading a closed terminal gives an error; reading a closed pipe gives end of file.
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

TEST(Progress, IsDrawnOnATerminalOncePerPercentAndErased) {
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
