// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace furrow::cli {

// A progress bar on standard error. It is drawn on a terminal only, and redrawn only when the
// percentage changes, so Set() is cheap enough to call per frame.
class Progress {
 public:
  // `label`: text before the bar. `total`: the value of Set() at 100%.
  Progress(std::string label, std::int64_t total);
  ~Progress();  // erases the bar
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Sets the completed part, [0, total].
  void Set(std::int64_t done);

 private:
  std::string label_;
  std::int64_t total_;
  int shown_ = -1;
  bool terminal_;
};

}  // namespace furrow::cli
