// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "protocol/messages/messages.h"

namespace furrow::protocol {

// 64-bit FNV-1a, fed byte by byte; numbers little-endian, strings followed by a zero byte.
// Not a defence against anyone: it tells skeletons and name tables apart, nothing more.
class Hasher {
 public:
  void String(std::string_view text);
  void U16(std::uint16_t value);
  void F32(float value);  // the bits as they stand
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  void Byte(std::uint8_t byte);
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

// Over everything that gives a pose its meaning: joints (name, parent, rest, tail), unit and
// blend-shape names; not over the subject. STANDARD.md section 6 gives the order of the bytes.
[[nodiscard]] std::uint64_t SkeletonHash(const SkeletonOffer& offer);

// Over the names in order; 0 for none.
[[nodiscard]] std::uint64_t NamesHash(std::span<const std::string> names);

}  // namespace furrow::protocol
