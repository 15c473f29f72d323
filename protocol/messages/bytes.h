// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace furrow::protocol {

// Read and write integers in little- or big-endian byte order. `bytes` has sizeof(T) bytes and may
// have any alignment. Compilers turn each loop into a single move.
template <class T>
[[nodiscard]] T LoadLittle(const std::uint8_t* bytes) {
  std::make_unsigned_t<T> value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    value |= static_cast<std::make_unsigned_t<T>>(bytes[i]) << (8 * i);
  }
  return static_cast<T>(value);
}

template <class T>
void StoreLittle(T value, std::uint8_t* bytes) {
  const auto bits = static_cast<std::make_unsigned_t<T>>(value);
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bytes[i] = static_cast<std::uint8_t>(bits >> (8 * i));
  }
}

template <class T>
[[nodiscard]] T LoadBig(const std::uint8_t* bytes) {
  std::make_unsigned_t<T> value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    value |= static_cast<std::make_unsigned_t<T>>(bytes[i]) << (8 * (sizeof(T) - 1 - i));
  }
  return static_cast<T>(value);
}

template <class T>
void StoreBig(T value, std::uint8_t* bytes) {
  const auto bits = static_cast<std::make_unsigned_t<T>>(value);
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bytes[i] = static_cast<std::uint8_t>(bits >> (8 * (sizeof(T) - 1 - i)));
  }
}

}  // namespace furrow::protocol
