// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace furrow::bench {

// A ring of messages in shared memory, for one writer and any number of readers. A sequence lock
// protects each slot: the writer never waits, and a reader that is overtaken skips to the newest
// message. Readers never write, so they could map the ring read-only.
//
// After H.-J. Boehm, "Can seqlocks get along with programming language memory models?" (2012): the
// payload consists of relaxed atomic words, so that a torn read is not a data race.
struct Ring {
  static constexpr std::size_t kSlots = 256;
  static constexpr std::size_t kMaxBytes = 1200;

  struct alignas(64) Slot {
    std::atomic<std::uint32_t> sequence;  // odd while the writer is inside
    std::atomic<std::uint32_t> size;      // bytes
    std::array<std::atomic<std::uint64_t>, kMaxBytes / 8> words;
  };

  // Messages written so far; the word that readers sleep on.
  alignas(64) std::atomic<std::uint32_t> written;
  std::array<Slot, kSlots> slots;

  // Adds a message of at most kMaxBytes.
  void Write(std::span<const std::uint8_t> message);

  // Copies message number `number` (from 0) to `out` and returns its size in bytes, or 0 if the
  // writer has overwritten it. Precondition: `number` < written.
  [[nodiscard]] std::size_t Read(std::uint32_t number,
                                 std::span<std::uint8_t, kMaxBytes> out) const;
};

static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

// Wakes all readers that sleep in WaitForNews().
void WakeReaders(Ring& ring);
// Sleeps until `written` differs from `seen`. Returns false after `timeout_ms`.
[[nodiscard]] bool WaitForNews(const Ring& ring, std::uint32_t seen, int timeout_ms);

}  // namespace furrow::bench
