// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace furrow::server {

// Counters that many threads add to have a slot per thread: one shared counter would move between
// processor caches at every pose. Readers sum the slots.
//
// The first threads that count have a slot of their own: all those of the network (kMaxThreads),
// and some others, which may count first. Later ones share the rest.
inline constexpr std::size_t kOwnSlots = 80;
inline constexpr std::size_t kThreadSlots = 84;

// The slot of the thread that was number `number` to count, from 0.
[[nodiscard]] constexpr std::size_t SlotOfNumber(std::size_t number) {
  if (number < kOwnSlots) return number;
  return kOwnSlots + number % (kThreadSlots - kOwnSlots);
}

// The slot of the calling thread.
[[nodiscard]] inline std::size_t SlotOfThread() {
  static std::atomic<std::size_t> next = 0;
  thread_local const std::size_t slot = SlotOfNumber(next.fetch_add(1, std::memory_order_relaxed));
  return slot;
}

// Adds to a number in slot `slot`, that of the calling thread. In a slot of its own, this costs no
// locked instruction, which would wait for all earlier stores.
inline void AddInSlot(std::size_t slot, std::atomic<std::uint64_t>& number, std::uint64_t count) {
  if (slot < kOwnSlots) {
    number.store(number.load(std::memory_order_relaxed) + count, std::memory_order_relaxed);
  } else {
    number.fetch_add(count, std::memory_order_relaxed);
  }
}

}  // namespace furrow::server
