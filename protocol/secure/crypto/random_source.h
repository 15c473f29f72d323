// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "protocol/secure/crypto/secret.h"

namespace furrow::protocol::secure {

// Where keys, nonces and indices come from. Tests and vectors use a source that repeats.
class RandomSource {
 public:
  virtual ~RandomSource() = default;
  virtual void Fill(std::span<std::uint8_t> bytes) = 0;

  // A random integer of type T.
  template <class T>
  [[nodiscard]] T Number() {
    std::uint8_t bytes[sizeof(T)];
    Fill(bytes);
    T value = 0;
    for (const std::uint8_t byte : bytes) value = static_cast<T>(value << 8 | byte);
    return value;
  }
  [[nodiscard]] Key MakeKey() {
    Key key;
    Fill(key.bytes());
    return key;
  }
};

// The random numbers of the operating system. Safe to use from several threads.
[[nodiscard]] RandomSource& SystemRandom();

}  // namespace furrow::protocol::secure
