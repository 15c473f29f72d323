// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>

namespace furrow::server {

// Counters that many threads add to have a slot per thread: one shared counter would move between
// processor caches at every pose. Readers sum the slots. Beyond this number, threads share slots.
inline constexpr std::size_t kThreadSlots = 16;

// The slot of the calling thread.
[[nodiscard]] inline std::size_t SlotOfThread() {
  static std::atomic<std::size_t> next = 0;
  thread_local const std::size_t slot = next.fetch_add(1, std::memory_order_relaxed) % kThreadSlots;
  return slot;
}

}  // namespace furrow::server
