// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace furrow {

// Memory of the process that `operator new` uses when the system has no more. Without it, a lack of
// memory would end the process in the middle of clearing up: some destructors allocate, such as
// those of nlohmann::json, and may not throw.
//
// A third of it serves any allocation, a third only those in a Scope, and the rest only those that
// are made while an exception unwinds the stack, so that what std::bad_alloc interrupts can be
// destroyed. When none of them helps, `operator new` throws std::bad_alloc as ever. The memory is
// never touched; it only holds address space. It helps against limits of address space and of data
// (RLIMIT_AS, RLIMIT_DATA) and against a kernel that commits no more than it has, but not against
// one that kills processes.
class MemoryReserve {
 public:
  static constexpr std::size_t kChunkBytes = std::size_t{2} << 20;
  static constexpr std::size_t kChunks = 12;
  static constexpr std::size_t kStackBytes = std::size_t{1} << 20;

  // From now on, for all threads. Call it once, in the main thread of a program that owns its
  // process. Also maps kStackBytes of the main thread's stack, unless its limit is smaller. The
  // stacks of other threads are mapped in full at their start.
  static void Install();
  // Fills the reserve up, as far as there is memory again. Call it about once per second. Returns
  // how many chunks were used since the last call. Without effect before Install().
  static std::size_t Refill();
  // The part for any allocation is used up: begin nothing that may wait.
  [[nodiscard]] static bool IsShort();

  // While it exists, this thread runs code whose destructors allocate.
  class Scope {
   public:
    Scope();
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
  };
};

}  // namespace furrow
