// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

namespace furrow::server {

// The log of furrowd on stderr, one line per message: plain text, or one JSON object with "time",
// "level" and "message".
//
// A background thread writes. If it cannot keep up, the oldest lines are dropped, so a reader of
// stderr that is slow or stuck never blocks a network thread. LimitedSink limits the rate. The
// destructor writes the remaining lines.
class Log {
 public:
  explicit Log(bool json);
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

 private:
  std::shared_ptr<void> logger_;  // must outlive the background thread
};

}  // namespace furrow::server
