// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

namespace furrow::server {

// The log of furrowd on stderr, one line per message. The constructor makes it the target of all
// spdlog calls.
//
// A background thread writes. If it cannot keep up, the oldest lines are dropped, so a reader of
// stderr that is slow or stuck never blocks a network thread. LimitedSink limits the rate. The
// destructor writes the remaining lines.
class Log {
 public:
  // `json`: each line is a JSON object with "time", "level" and "message"; else plain text.
  explicit Log(bool json);
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

 private:
  std::shared_ptr<void> logger_;  // must outlive the background thread
};

}  // namespace furrow::server
