// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace furrow {

// Memory of the process that `operator new` uses when the system has no more. Without it, a lack of
// memory would end the process in the middle of clearing up: some destructors allocate, such as
// those of nlohmann::json, and may not throw.
//
// Half of it serves any allocation. The rest serves only those that are made while an exception is
// on its way, so that what std::bad_alloc interrupts can be destroyed. When neither helps,
// `operator new` throws std::bad_alloc as ever. The memory takes no pages until it is used.
class MemoryReserve {
 public:
  static constexpr std::size_t kChunkBytes = std::size_t{2} << 20;
  static constexpr std::size_t kChunks = 8;
  static constexpr std::size_t kStackBytes = std::size_t{1} << 20;

  // From now on, for all threads. Call it once, in the main thread of a program that owns its
  // process. Also maps kStackBytes of the main thread's stack; those of others are mapped whole.
  static void Install();
  // Fills the reserve up, as far as there is memory again. Call it about once per second. Returns
  // how many chunks were used since the last call.
  static std::size_t Refill();
};

}  // namespace furrow
