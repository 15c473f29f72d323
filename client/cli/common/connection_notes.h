// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <utility>

namespace furrow::cli {

// Prints when the connection is lost and when it is back.
class ConnectionNotes {
 public:
  void Lost() {
    if (!std::exchange(lost_, true)) {
      std::fprintf(stderr, "furrow: the connection was lost; trying again until Ctrl-C\n");
    }
  }
  // Returns true if the connection had been lost.
  bool Connected() {
    if (!std::exchange(lost_, false)) return false;
    std::fprintf(stderr, "furrow: connected again\n");
    return true;
  }
  [[nodiscard]] bool lost() const { return lost_; }

 private:
  bool lost_ = false;
};

}  // namespace furrow::cli
