// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace furrow::test {

// How often this program has called operator new, in any form (allocation_counter.cpp replaces it).
[[nodiscard]] std::uint64_t NumAllocations();

// While it lives, operator new succeeds `count` times on this thread and then throws
// std::bad_alloc. One at a time.
class AllocationLimit {
 public:
  explicit AllocationLimit(std::uint64_t count);
  ~AllocationLimit();
  AllocationLimit(const AllocationLimit&) = delete;
  AllocationLimit& operator=(const AllocationLimit&) = delete;
};

}  // namespace furrow::test
