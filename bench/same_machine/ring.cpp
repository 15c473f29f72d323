// SPDX-License-Identifier: Apache-2.0
#include "bench/same_machine/ring.h"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstring>
#include <ctime>

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace furrow::bench {

void Ring::Write(std::span<const std::uint8_t> message) {
  const std::uint32_t number = written.load(std::memory_order_relaxed);
  Slot& slot = slots[number % kSlots];
  slot.sequence.store(2 * number + 1, std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_release);
  slot.size.store(static_cast<std::uint32_t>(message.size()), std::memory_order_relaxed);
  for (std::size_t at = 0; at < message.size(); at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, &message[at], std::min<std::size_t>(8, message.size() - at));
    slot.words[at / 8].store(word, std::memory_order_relaxed);
  }
  slot.sequence.store(2 * number + 2, std::memory_order_release);
  written.store(number + 1, std::memory_order_release);
}

std::size_t Ring::Read(std::uint32_t number, std::span<std::uint8_t, kMaxBytes> out) const {
  const Slot& slot = slots[number % kSlots];
  const std::uint32_t complete = 2 * number + 2;
  if (slot.sequence.load(std::memory_order_acquire) != complete) return 0;
  const std::size_t size =
      std::min<std::size_t>(slot.size.load(std::memory_order_relaxed), kMaxBytes);
  for (std::size_t at = 0; at < size; at += 8) {
    const std::uint64_t word = slot.words[at / 8].load(std::memory_order_relaxed);
    std::memcpy(&out[at], &word, std::min<std::size_t>(8, size - at));
  }
  std::atomic_thread_fence(std::memory_order_acquire);
  return slot.sequence.load(std::memory_order_relaxed) == complete ? size : 0;
}

void WakeReaders(Ring& ring) {
  syscall(SYS_futex, &ring.written, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

bool WaitForNews(const Ring& ring, std::uint32_t seen, int timeout_ms) {
  const timespec timeout{timeout_ms / 1000, (timeout_ms % 1000) * 1'000'000L};
  const long result = syscall(SYS_futex, &ring.written, FUTEX_WAIT, seen, &timeout, nullptr, 0);
  return result == 0 || errno == EAGAIN || errno == EINTR;
}

}  // namespace furrow::bench
