// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace furrow::capi {

// When a rejected request is due again. Time is a parameter: microseconds of a monotonic clock.
class Retry {
 public:
  void SetDue(std::int64_t due_us) { due_us_ = due_us; }
  void Clear() { due_us_.reset(); }
  // True if the request is due; then false until the next SetDue().
  bool Take(std::int64_t now_us) {
    if (!due_us_ || now_us < *due_us_) return false;
    due_us_.reset();
    return true;
  }

 private:
  std::optional<std::int64_t> due_us_;
};

}  // namespace furrow::capi
