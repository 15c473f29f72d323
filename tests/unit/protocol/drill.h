// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

// Hostile inputs for every parser of the wire.
namespace furrow::protocol::test {

using Bytes = std::vector<std::uint8_t>;

// Calls `parse` with every proper prefix of `good`. Each prefix has a heap block of exactly its
// size, so a sanitizer detects the first byte read beyond the end.
template <class Parse>
void ForEveryTruncation(std::span<const std::uint8_t> good, const Parse& parse) {
  for (std::size_t size = 0; size < good.size(); ++size) {
    const auto block = std::make_unique<std::uint8_t[]>(size);
    std::copy_n(good.begin(), size, block.get());
    parse(std::span<const std::uint8_t>(block.get(), size));
  }
}

// Calls `parse` with variants of `good`. Each variant has one byte replaced by an edge value.
template <class Parse>
void ForEveryCorruption(std::span<const std::uint8_t> good, const Parse& parse) {
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (const int value : {0x00, 0x01, 0x7F, 0x80, 0xFF}) {
      const auto block = std::make_unique<std::uint8_t[]>(good.size());
      std::copy(good.begin(), good.end(), block.get());
      block[at] = static_cast<std::uint8_t>(value);
      parse(std::span<const std::uint8_t>(block.get(), good.size()));
    }
  }
}

}  // namespace furrow::protocol::test
