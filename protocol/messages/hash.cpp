// SPDX-License-Identifier: Apache-2.0
#include "protocol/messages/hash.h"

#include <bit>

namespace furrow::protocol {

// 64-bit FNV-1a.
void Hasher::Byte(std::uint8_t byte) { value_ = (value_ ^ byte) * 0x100000001b3ULL; }

void Hasher::String(std::string_view text) {
  for (const char c : text) Byte(static_cast<std::uint8_t>(c));
  // Ends the text, so that "ab", "c" and "a", "bc" differ. Names hold no zero bytes.
  Byte(0);
}

void Hasher::U16(std::uint16_t value) {
  Byte(static_cast<std::uint8_t>(value));
  Byte(static_cast<std::uint8_t>(value >> 8));
}

void Hasher::F32(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  U16(static_cast<std::uint16_t>(bits));
  U16(static_cast<std::uint16_t>(bits >> 16));
}

namespace {

void Add(Hasher& hasher, const Vec3& v) {
  hasher.F32(v.x);
  hasher.F32(v.y);
  hasher.F32(v.z);
}

}  // namespace

std::uint64_t SkeletonHash(const SkeletonOffer& offer) {
  Hasher hasher;
  hasher.U16(static_cast<std::uint16_t>(offer.joints.size()));
  for (const OfferedJoint& joint : offer.joints) {
    hasher.String(joint.name);
    hasher.U16(static_cast<std::uint16_t>(joint.parent));
    Add(hasher, joint.rest_translation);
    const Quat& q = joint.rest_rotation;
    Add(hasher, {q.x, q.y, q.z});
    hasher.F32(q.w);
    Add(hasher, joint.rest_scale);
    hasher.U16(joint.has_tail ? 1 : 0);
    if (joint.has_tail) Add(hasher, joint.tail);
  }
  hasher.F32(offer.metres_per_unit);
  hasher.U16(static_cast<std::uint16_t>(offer.blend_shape_names.size()));
  for (const std::string& name : offer.blend_shape_names) hasher.String(name);
  return hasher.value();
}

std::uint64_t NamesHash(std::span<const std::string> names) {
  if (names.empty()) return 0;
  Hasher hasher;
  for (const std::string& name : names) hasher.String(name);
  return hasher.value();
}

}  // namespace furrow::protocol
