// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "server/core/time.h"

namespace furrow::server {

// Knows for how long this process has not run: stopped by a signal, or without a core. Its thread
// looks at the clock ten times per second and waits for nothing else, so a thread that waits for
// another program makes no pause.
class Pulse {
 public:
  // `now`: called on any thread.
  explicit Pulse(std::function<Time()> now);
  // The longest pause since the last call, up to this moment. Thread-safe.
  [[nodiscard]] Time TakeLongestPause();

 private:
  void Run(const std::stop_token& stop);
  void Beat();  // needs the mutex

  const std::function<Time()> now_;
  std::mutex mutex_;
  std::condition_variable_any stopped_;
  Time last_{0};
  Time longest_{0};
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace furrow::server
