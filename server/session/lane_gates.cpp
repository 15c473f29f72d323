// SPDX-License-Identifier: Apache-2.0
#include "server/session/lane_gates.h"

namespace furrow::server {

void LaneGates::Enter(int lane) {
  if (waiting_.load(std::memory_order_relaxed) > 0) {
    const std::lock_guard behind(turnstile_);
  }
  gates_[static_cast<std::size_t>(lane)].mutex.lock();
}

void LaneGates::EnterAlone() {
  waiting_.fetch_add(1, std::memory_order_relaxed);
  turnstile_.lock();
  for (Gate& gate : gates_) gate.mutex.lock();
  waiting_.fetch_sub(1, std::memory_order_relaxed);
}

void LaneGates::LeaveAlone() {
  for (Gate& gate : gates_) gate.mutex.unlock();
  turnstile_.unlock();
}

void LaneGates::LeaveAloneInto(int lane) {
  for (std::size_t i = 0; i < gates_.size(); ++i) {
    if (i != static_cast<std::size_t>(lane)) gates_[i].mutex.unlock();
  }
  turnstile_.unlock();
}

}  // namespace furrow::server
