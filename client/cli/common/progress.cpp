// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/progress.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <unistd.h>

namespace furrow::cli {

Progress::Progress(std::string label, std::int64_t total)
    : label_(std::move(label)),
      total_(std::max<std::int64_t>(total, 1)),
      terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  // Returns to the start of the line and erases it (ECMA-48, EL), so that nothing stays behind.
  if (terminal_ && shown_ >= 0) std::fputs("\r\033[K", stderr);
}

void Progress::Set(std::int64_t done) {
  const int percent = static_cast<int>(std::clamp<std::int64_t>(done * 100 / total_, 0, 100));
  if (!terminal_ || percent == shown_) return;
  shown_ = percent;
  constexpr int kCells = 32;
  const std::string bar(static_cast<std::size_t>(percent * kCells / 100), '#');
  std::fprintf(stderr, "\r%s [%-*s] %3d%%", label_.c_str(), kCells, bar.c_str(), percent);
}

}  // namespace furrow::cli
