// SPDX-License-Identifier: Apache-2.0
#include "base/process/memory_reserve.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <exception>
#include <new>

#include <sys/mman.h>
#include <sys/resource.h>

namespace furrow {
namespace {

constexpr std::size_t kThird = MemoryReserve::kChunks / 3;

std::array<std::atomic<void*>, MemoryReserve::kChunks> chunks;
std::atomic<std::size_t> num_used = 0;
std::atomic<bool> is_installed = false;
thread_local int scopes = 0;

// Gives one of the first `end` chunks back to the system. False: there is none.
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
  const std::size_t thirds = std::uncaught_exceptions() > 0 ? 3 : scopes > 0 ? 2 : 1;
  if (!Release(thirds * kThird)) throw std::bad_alloc();
}

// The kernel maps the stack of the main thread as it grows, and ends the process if it cannot.
[[gnu::noinline]] void MapStack() {
  [[maybe_unused]] volatile char stack[MemoryReserve::kStackBytes];
  stack[0] = 0;  // the lowest address
}

}  // namespace

MemoryReserve::Scope::Scope() { ++scopes; }
MemoryReserve::Scope::~Scope() { --scopes; }

void MemoryReserve::Install() {
  rlimit stack{};
  if (getrlimit(RLIMIT_STACK, &stack) == 0 && stack.rlim_cur >= 2 * kStackBytes) MapStack();
  is_installed = true;
  Refill();
  std::set_new_handler(&OnExhaustion);
}

std::size_t MemoryReserve::Refill() {
  if (!is_installed) return 0;
  // Backwards, because clearing up matters most.
  for (std::size_t i = chunks.size(); i-- > 0;) {
    if (chunks[i] != nullptr) continue;
    void* const chunk =
        mmap(nullptr, kChunkBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (chunk == MAP_FAILED) break;
    chunks[i] = chunk;
  }
  return num_used.exchange(0);
}

bool MemoryReserve::IsShort() {
  return is_installed && std::all_of(chunks.begin(), chunks.begin() + kThird,
                                     [](const auto& chunk) { return chunk == nullptr; });
}

}  // namespace furrow
