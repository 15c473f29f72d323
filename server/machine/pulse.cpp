// SPDX-License-Identifier: Apache-2.0
#include "server/machine/pulse.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace furrow::server {

Pulse::Pulse(std::function<Time()> now)
    : now_(std::move(now)),
      last_(now_()),
      thread_([this](const std::stop_token& stop) { Run(stop); }) {}

void Pulse::Beat() {
  const Time now = now_();
  longest_ = std::max(longest_, now - last_);
  last_ = now;
}

Time Pulse::TakeLongestPause() {
  const std::lock_guard lock(mutex_);
  Beat();
  return std::exchange(longest_, Time{0});
}

void Pulse::Run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    Beat();
    stopped_.wait_for(lock, stop, std::chrono::milliseconds(100), [] { return false; });
  }
}

}  // namespace furrow::server
