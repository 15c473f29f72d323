// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace furrow::cli {

// A progress bar on standard error: drawn on a terminal, silent in a pipe. Redrawn when the shown
// percentage changes, so it costs nothing a frame.
class Progress {
 public:
  Progress(std::string label, std::int64_t total);
  ~Progress();  // wipes the bar
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void Set(std::int64_t done);

 private:
  std::string label_;
  std::int64_t total_;
  int shown_ = -1;
  bool terminal_;
};

}  // namespace furrow::cli
