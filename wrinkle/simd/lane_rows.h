// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

namespace furrow::wrinkle {

// A row is sixteen numbers that are processed side by side: one vector of AVX-512, two of AVX2,
// four of SSE4 and NEON. Tables of rows are the same for every instruction set. Private to
// wrinkle/.
inline constexpr std::size_t kRowLanes = 16;
inline constexpr std::size_t kRowAlignment = 64;  // a cache line

struct alignas(kRowAlignment) FloatRow {
  float at[kRowLanes] = {};
};

struct alignas(kRowAlignment) IntRow {
  std::int32_t at[kRowLanes] = {};
};

// The number of rows that hold `count` numbers.
[[nodiscard]] constexpr std::size_t NumRows(std::size_t count) {
  return (count + kRowLanes - 1) / kRowLanes;
}

// Aligns lists to rows, so that no vector crosses a cache line.
template <class T>
struct RowAllocator {
  using value_type = T;

  RowAllocator() = default;
  template <class U>
  RowAllocator(const RowAllocator<U>&) noexcept {}  // NOLINT: allocators convert

  [[nodiscard]] T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{kRowAlignment}));
  }
  void deallocate(T* memory, std::size_t) noexcept {
    ::operator delete (memory, std::align_val_t{kRowAlignment});
  }
  friend bool operator==(const RowAllocator&, const RowAllocator&) { return true; }
};
using RowList = std::vector<float, RowAllocator<float>>;

}  // namespace furrow::wrinkle
