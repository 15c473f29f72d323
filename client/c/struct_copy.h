// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "client/c/include/furrow/furrow.h"

// Structs of the C interface that may come from an older or newer program. `struct_size`, the first
// field, states how much of a struct the program knows.
namespace furrow::capi {

// Every struct holds at least its size and one more field.
inline constexpr std::uint32_t kLeastStructBytes = 8;
// A larger size is a mistake, such as a struct that was never initialised.
inline constexpr std::uint32_t kMostStructBytes = 4096;

[[nodiscard]] inline bool IsStructSize(std::uint32_t size) {
  return size >= kLeastStructBytes && size <= kMostStructBytes;
}

// Copies the program's struct. Fields that an older program does not know become 0.
//
// Errors: FURROW_INVALID_ARGUMENT (null, or not a size), FURROW_UNSUPPORTED (a newer program has
// set a field that this library does not know).
template <class T>
[[nodiscard]] furrow_status CopyIn(const T* from, T* to) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (from == nullptr) return FURROW_INVALID_ARGUMENT;
  const std::uint32_t size = from->struct_size;
  if (!IsStructSize(size)) return FURROW_INVALID_ARGUMENT;
  const auto* const bytes = reinterpret_cast<const unsigned char*>(from);
  for (std::size_t i = sizeof(T); i < size; ++i) {
    if (bytes[i] != 0) return FURROW_UNSUPPORTED;
  }
  *to = T{};
  std::memcpy(to, from, std::min<std::size_t>(size, sizeof(T)));
  return FURROW_OK;
}

// Fills the part of the program's struct that the program knows, and keeps its struct_size. Bytes
// that this library does not know become 0.
template <class T>
[[nodiscard]] furrow_status CopyOut(const T& from, T* to) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (to == nullptr || !IsStructSize(to->struct_size)) return FURROW_INVALID_ARGUMENT;
  const std::uint32_t size = to->struct_size;
  std::memset(static_cast<void*>(to), 0, size);
  std::memcpy(static_cast<void*>(to), &from, std::min<std::size_t>(size, sizeof(T)));
  to->struct_size = size;
  return FURROW_OK;
}

}  // namespace furrow::capi
