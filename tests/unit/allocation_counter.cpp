// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/allocation_counter.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::uint64_t> num_allocations{0};
constexpr std::uint64_t kUnlimited = UINT64_MAX;
thread_local std::uint64_t num_allowed = kUnlimited;

void* Allocate(std::size_t size, std::size_t alignment) {
  num_allocations.fetch_add(1, std::memory_order_relaxed);
  if (num_allowed != kUnlimited) {
    if (num_allowed == 0) throw std::bad_alloc();
    --num_allowed;
  }
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  void* const memory = std::aligned_alloc(alignment, rounded == 0 ? alignment : rounded);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

// Sanitizers check that memory goes back the way it came, so the nothrow form, which the standard
// library uses on its own, is here too. The array forms call these by default.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return Allocate(size, alignof(std::max_align_t));
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void* operator new(std::size_t size) { return Allocate(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return Allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace furrow::test {

std::uint64_t NumAllocations() { return num_allocations.load(std::memory_order_relaxed); }

AllocationLimit::AllocationLimit(std::uint64_t count) { num_allowed = count; }
AllocationLimit::~AllocationLimit() { num_allowed = kUnlimited; }

}  // namespace furrow::test
