// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace furrow::wrinkle {

// Requests a list from memory, so that it is in the cache when it is read soon.
template <class T>
void Prefetch(std::span<const T> list) {
  constexpr std::size_t kCacheLine = 64;
  const auto* const bytes = reinterpret_cast<const std::byte*>(list.data());
  for (std::size_t i = 0; i < list.size_bytes(); i += kCacheLine) {
    __builtin_prefetch(bytes + i, 0, 2);
  }
}

}  // namespace furrow::wrinkle
