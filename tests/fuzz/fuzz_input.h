// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace furrow::fuzz {

// A fuzz target's input, read from front to back as a program. Past its end, bytes are 0.
class Input {
 public:
  explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  [[nodiscard]] bool empty() const { return bytes_.empty(); }
  std::uint8_t Byte() {
    if (bytes_.empty()) return 0;
    const std::uint8_t byte = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return byte;
  }
  // A number in [-1, 1].
  float Signed() { return (static_cast<float>(Byte()) - 128.0f) / 128.0f; }
  // The next `count` bytes, or those that are left.
  std::span<const std::uint8_t> Bytes(std::size_t count) {
    const auto taken = bytes_.first(std::min(count, bytes_.size()));
    bytes_ = bytes_.subspan(taken.size());
    return taken;
  }
  // The bytes up to the next zero byte, which is skipped, or those that are left.
  std::span<const std::uint8_t> UntilZero() {
    const auto end = std::ranges::find(bytes_, std::uint8_t{0});
    const auto taken = Bytes(static_cast<std::size_t>(end - bytes_.begin()));
    Byte();
    return taken;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace furrow::fuzz
