// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>

#include "server/core/log_level.h"

namespace furrow::server {

// The log of furrowd on stderr, one line per message. The constructor makes it the target of all
// spdlog calls.
//
// A background thread writes. If it cannot keep up, the oldest lines are dropped, so a reader of
// stderr that is slow or stuck never blocks a network thread. LimitedSink limits the rate. The
// destructor writes the remaining lines.
class Log {
 public:
  struct Settings {
    bool json = false;  // each line is a JSON object with "time", "level" and "message"
    LogLevel level = LogLevel::kInfo;
    // The journal of systemd reads the lines: they begin with their priority (sd-daemon(3)), and
    // plain text has no time, which the journal adds. A prefix instead of its socket, because one
    // stream stays in order, and passes LimitedSink and every sandbox.
    bool journal = false;
  };
  explicit Log(const Settings& settings);
  ~Log();
  // Changes the level while the daemon runs.
  static void SetLevel(LogLevel level);
  // Waits until the lines so far are written, at most for `patience`: for a process that ends
  // without the destructor. Does nothing without a Log.
  static void WriteOut(std::chrono::milliseconds patience);
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

 private:
  std::shared_ptr<void> logger_;  // must outlive the background thread
};

}  // namespace furrow::server
