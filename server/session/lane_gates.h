// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <vector>

namespace furrow::server {

// Who may be at work on what several threads share: each of them in its own lane, all at once; or
// one of them, alone. To enter a lane touches memory of no other lane, so that poses, which come
// often, cost nothing for what comes seldom; to be alone waits for every lane.
//
// Whoever waits to be alone is let in before the lanes are entered again: however busy they are,
// it waits for what is going on in them, and no longer.
class LaneGates {
 public:
  explicit LaneGates(int lanes) : gates_(static_cast<std::size_t>(lanes)) {}

  // Not from within a lane, and not alone.
  void Enter(int lane);
  void Leave(int lane) { gates_[static_cast<std::size_t>(lane)].mutex.unlock(); }
  // Not from within a lane.
  void EnterAlone();
  void LeaveAlone();
  // The same, but the caller goes on in its lane.
  void LeaveAloneInto(int lane);

 private:
  struct alignas(64) Gate {
    std::mutex mutex;
  };
  std::vector<Gate> gates_;
  std::mutex turnstile_;
  std::atomic<int> waiting_ = 0;  // to be alone
};

}  // namespace furrow::server
