// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "protocol/messages/messages.h"

namespace furrow::protocol {

// "Smallest three" rotations in 48 bits (STANDARD.md section 5): the component of largest magnitude
// is left out (made positive by the quaternion's sign), the others lie in [-1/sqrt(2), 1/sqrt(2)]
// and take 15 bits each, 0 to 32766, so that 0 is exact.
//
// The decoded rotation differs by at most kMaxRotationError radians: three components are off by
// half a step d, the rebuilt one by at most 3d, so the quaternion by sqrt(12) d, and an angle is
// twice the distance of unit quaternions: 4 sqrt(3) d = 1.495e-4.
inline constexpr float kMaxRotationError = 1.5e-4f;

using PackedQuat = std::array<std::uint16_t, 3>;  // low word first

// Precondition: unit length within 1e-2.
[[nodiscard]] PackedQuat PackQuat(const Quat& rotation);
// False (and identity) where the bits are no rotation: bit 47 set, a 15-bit value of 32767, or
// components whose squares exceed 1.
[[nodiscard]] bool UnpackQuat(const PackedQuat& packed, Quat& rotation);

// Offsets in [-range, range] in 16 bits: value = range * i / 32767, clamped. Off by range / 65534.
[[nodiscard]] std::int16_t PackOffset(float value, float range);
[[nodiscard]] float UnpackOffset(std::int16_t packed, float range);

// Blend shapes in (-2, 2) in 16 bits: value = i / 16384, so that 0 and 1 are exact; clamped. Off by
// at most 1 / 32768.
[[nodiscard]] std::int16_t PackBlendShape(float value);
[[nodiscard]] float UnpackBlendShape(std::int16_t packed);

// Weights in [0, 1] in 8 bits: value = i / 255; clamped.
[[nodiscard]] std::uint8_t PackWeight(float value);
[[nodiscard]] float UnpackWeight(std::uint8_t packed);

}  // namespace furrow::protocol
