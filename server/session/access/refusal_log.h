// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string_view>

#include "server/core/time.h"
#include "server/shares/token_bucket.h"

namespace furrow::server {

// Logs who is refused and why, at most 10 lines at once and one per 5 s in the long run, because
// strangers cause them. The next line counts those that were left out. Thread-safe.
class RefusalLog {
 public:
  // `who`: returns the name of the client in the log; not called for what is left out. `why`: a
  // sentence without a full stop.
  template <class Who>
  void Note(Who&& who, std::string_view why, Time now) {
    if (const auto left_out = Take(now)) Write(who(), why, *left_out);
  }

 private:
  // How many were left out before this one; nothing if this one is left out, too.
  [[nodiscard]] std::optional<std::uint64_t> Take(Time now);
  static void Write(std::string_view who, std::string_view why, std::uint64_t left_out);

  std::mutex mutex_;
  TokenBucket bucket_{0.2, 10.0};
  std::uint64_t left_out_ = 0;
};

}  // namespace furrow::server
