// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "server/config/config.h"

namespace furrow::server {

// The program's log, on stderr, a line a message: for people, or (--log-json) one JSON object a
// line with "time", "level" and "message".
//
// A thread of its own writes, and where it cannot keep up the oldest lines go: whoever reads our
// stderr slowly, or not at all, never blocks a network thread. How much is written in a second is
// limited (LimitedSink). The destructor writes what still waits.
class Log {
 public:
  explicit Log(const Config& config);
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

 private:
  std::shared_ptr<void> logger_;  // outlives the writing thread, which the destructor joins
};

}  // namespace furrow::server
