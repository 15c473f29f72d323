// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "protocol/messages/messages.h"

namespace furrow::protocol {

// Which numbers of a pose the encoder quantises.
struct PoseEncoding {
  bool quantise_rotations = false;     // 6 bytes per joint, error up to kMaxRotationError
  bool quantise_translations = false;  // 6 bytes, error per axis up to largest offset / 65534
  bool quantise_blend_shapes = false;  // 2 bytes, clamped to (-2, 2), error up to 1/32768
  // Everything quantised.
  [[nodiscard]] static PoseEncoding Small() { return {true, true, true}; }
};

// Rotations as the "smallest three" components in 48 bits (STANDARD.md section 5). The component of
// largest magnitude is made positive by the sign of the quaternion and left out. The other three
// lie in [-1/sqrt(2), 1/sqrt(2)] and take 15 bits each, 0 to 32766, so that 0 is exact.
//
// Error of a decoded rotation, in radians. With a quantisation step d, each stored component is off
// by at most d/2 and the restored component by at most 3d. The quaternion is off by at most
// sqrt(12) d and the angle, twice the distance of unit quaternions, by 4 sqrt(3) d = 1.495e-4.
inline constexpr float kMaxRotationError = 1.5e-4f;

using PackedQuat = std::array<std::uint16_t, 3>;  // low word first

// Precondition: unit length within 1e-2.
[[nodiscard]] PackedQuat PackQuat(const Quat& rotation);
// Returns false and the identity if the bits are not a rotation: bit 47 set, a 15-bit value of
// 32767, or a sum of squares above 1.
[[nodiscard]] bool UnpackQuat(const PackedQuat& packed, Quat& rotation);

// Offsets in [-range, range] in 16 bits: value = range * i / 32767, clamped. Error: range / 65534.
[[nodiscard]] std::int16_t PackOffset(float value, float range);
[[nodiscard]] float UnpackOffset(std::int16_t packed, float range);

// Blend shapes in (-2, 2) in 16 bits: value = i / 16384, clamped. 0 and 1 are exact. Error: at most
// 1/32768.
[[nodiscard]] std::int16_t PackBlendShape(float value);
[[nodiscard]] float UnpackBlendShape(std::int16_t packed);

// Weights in [0, 1] in 8 bits: value = i / 255, clamped. Error: at most 1/510.
[[nodiscard]] std::uint8_t PackWeight(float value);
[[nodiscard]] float UnpackWeight(std::uint8_t packed);

}  // namespace furrow::protocol
