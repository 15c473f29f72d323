// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "protocol/messages/messages.h"

namespace furrow::protocol {

// Computes a 64-bit FNV-1a hash of the values added to it, in order. Numbers are hashed as
// little-endian bytes, strings with a zero byte at the end. The hash tells skeletons and name lists
// apart. It does not protect against deliberate collisions.
class Hasher {
 public:
  void String(std::string_view text);
  void U16(std::uint16_t value);
  void F32(float value);  // the IEEE 754 bits, so -0 and 0 differ
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  void Byte(std::uint8_t byte);
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

// Hashes everything that gives a pose its meaning: joints (name, parent, rest pose, tail),
// metres_per_unit and blend-shape names. The subject's name and offer.skeleton_hash are not part of
// it. STANDARD.md section 6 states the order.
[[nodiscard]] std::uint64_t SkeletonHash(const SkeletonOffer& offer);

// Hashes the names in order. Returns 0 for an empty list.
[[nodiscard]] std::uint64_t NamesHash(std::span<const std::string> names);

}  // namespace furrow::protocol
