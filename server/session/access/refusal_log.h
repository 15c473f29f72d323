// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <string_view>

#include "server/core/time.h"
#include "server/core/token_bucket.h"

namespace furrow::server {

// Logs who is refused and why, at most 10 lines at once and one per 5 s in the long run, because
// strangers cause them. The next line counts those that were left out. Thread-safe.
class RefusalLog {
 public:
  // `who`: the name of the client in the log. `why`: a sentence without a full stop.
  void Note(std::string_view who, std::string_view why, Time now);

 private:
  std::mutex mutex_;
  TokenBucket bucket_{0.2, 10.0};
  std::uint64_t left_out_ = 0;
};

}  // namespace furrow::server
