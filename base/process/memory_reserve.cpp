// SPDX-License-Identifier: Apache-2.0
#include "base/process/memory_reserve.h"

#include <array>
#include <atomic>
#include <exception>
#include <new>

#include <sys/mman.h>

namespace furrow {
namespace {

// The last half is for clearing up.
std::array<std::atomic<void*>, MemoryReserve::kChunks> chunks;
std::atomic<std::size_t> num_used = 0;

// Gives one chunk back to the system. False: there is none.
bool Release(std::size_t end) {
  for (std::size_t i = 0; i < end; ++i) {
    void* const chunk = chunks[i].exchange(nullptr);
    if (chunk == nullptr) continue;
    (void)munmap(chunk, MemoryReserve::kChunkBytes);
    ++num_used;
    return true;
  }
  return false;
}

// `operator new` tries again after it returns.
void OnExhaustion() {
  const bool clears_up = std::uncaught_exceptions() > 0;
  if (!Release(clears_up ? chunks.size() : chunks.size() / 2)) throw std::bad_alloc();
}

// The kernel maps the stack of the main thread as it grows, and ends the process if it cannot.
[[gnu::noinline]] void MapStack() {
  volatile char stack[MemoryReserve::kStackBytes];
  stack[0] = 0;  // its end
}

}  // namespace

void MemoryReserve::Install() {
  MapStack();
  Refill();
  std::set_new_handler(&OnExhaustion);
}

std::size_t MemoryReserve::Refill() {
  // Backwards, because clearing up matters most.
  for (std::size_t i = chunks.size(); i-- > 0;) {
    if (chunks[i] != nullptr) continue;
    void* const chunk =
        mmap(nullptr, kChunkBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (chunk == MAP_FAILED) break;
    void* none = nullptr;  // another daemon of this process may have been faster
    if (!chunks[i].compare_exchange_strong(none, chunk)) (void)munmap(chunk, kChunkBytes);
  }
  return num_used.exchange(0);
}

}  // namespace furrow
