// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace furrow::protocol::secure {

// Overwrites `bytes` with zeros in a way that the compiler cannot remove.
void Wipe(std::span<std::uint8_t> bytes);

// N secret bytes. Every copy wipes itself when it ends. There is no operator==: compare secrets
// with EqualInConstantTime().
template <std::size_t N>
class Secret {
 public:
  Secret() : bytes_{} {}
  explicit Secret(std::span<const std::uint8_t, N> bytes) {
    for (std::size_t i = 0; i < N; ++i) bytes_[i] = bytes[i];
  }
  Secret(const Secret&) = default;
  Secret& operator=(const Secret&) = default;
  ~Secret() { Wipe(bytes_); }

  [[nodiscard]] std::span<const std::uint8_t, N> bytes() const { return bytes_; }
  [[nodiscard]] std::span<std::uint8_t, N> bytes() { return bytes_; }

 private:
  std::array<std::uint8_t, N> bytes_;
};

// A key of 256 bits.
inline constexpr std::size_t kKeyBytes = 32;
using Key = Secret<kKeyBytes>;

}  // namespace furrow::protocol::secure
