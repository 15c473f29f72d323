// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace furrow::server::testing {

// The events of a simulation, by time in ms. Events of one time happen in the order of At().
class EventQueue {
 public:
  void At(std::int64_t time, std::function<void()> action) {
    std::uint32_t place = static_cast<std::uint32_t>(actions_.size());
    if (free_.empty()) {
      actions_.push_back(std::move(action));
    } else {
      place = free_.back();
      free_.pop_back();
      actions_[place] = std::move(action);
    }
    heap_.push_back({time, next_++, place});
    std::push_heap(heap_.begin(), heap_.end(), IsLater);
  }
  // Runs the next event, which sets now(). False: there is none up to `end`.
  bool Run(std::int64_t end) {
    if (heap_.empty() || heap_.front().time > end) return false;
    std::pop_heap(heap_.begin(), heap_.end(), IsLater);
    const Event event = heap_.back();
    heap_.pop_back();
    now_ = event.time;
    const auto action = std::move(actions_[event.place]);
    free_.push_back(event.place);
    action();
    return true;
  }
  [[nodiscard]] std::int64_t now() const { return now_; }

 private:
  struct Event {
    std::int64_t time = 0;
    std::uint32_t order = 0;
    std::uint32_t place = 0;  // of its action
  };
  static bool IsLater(const Event& a, const Event& b) {
    return a.time != b.time ? a.time > b.time : a.order > b.order;
  }

  std::vector<Event> heap_;
  std::vector<std::function<void()>> actions_;
  std::vector<std::uint32_t> free_;  // places without an event
  std::uint32_t next_ = 0;
  std::int64_t now_ = 0;
};

}  // namespace furrow::server::testing
