// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "protocol/messages/messages.h"

namespace furrow::protocol {

// Which numbers of a pose the encoder quantises.
struct PoseEncoding {
  bool quantise_rotations = false;     // 6 bytes per joint, error up to kMaxRotationError
  bool quantise_translations = false;  // 6 bytes; error per axis up to (largest offset) / 65534
  bool quantise_blend_shapes = false;  // 2 bytes; clamped to (-2, 2), error up to 1/32768
  // Quantises everything if the pose does not fit one datagram otherwise, and nothing if it does.
  bool quantise_to_fit = false;
  // The smallest encoding: everything quantised.
  [[nodiscard]] static PoseEncoding Small() { return {true, true, true}; }
  // For UDP: floats where they fit one datagram, else Small(). A lost fragment loses its message.
  [[nodiscard]] static PoseEncoding Fitting() { return {false, false, false, true}; }
};

// The functions below store a rotation as its "smallest three" components in 48 bits (STANDARD.md
// section 5). The component of largest magnitude is left out; q is negated first if it is negative.
// The other three are in [-1/sqrt(2), 1/sqrt(2)] and take 15 bits each, as 0 to 32766, so that 0 is
// exact.
//
// kMaxRotationError bounds the error of a decoded rotation, in radians. A component is rounded to
// steps of sqrt(2) / 32766, so each stored component is off by at most half a step, h = 2.158e-5.
// The restored component is the largest, so it is off by at most 3 h, and the quaternion by at most
// sqrt(3 + 9) h. The rotation's angle is off by twice that: 1.495e-4.
inline constexpr float kMaxRotationError = 1.5e-4f;

using PackedQuat = std::array<std::uint16_t, 3>;  // low word first

// Packs a rotation and normalises it. Precondition: its length is within 1e-2 of 1.
[[nodiscard]] PackedQuat PackQuat(const Quat& rotation);
// Unpacks a rotation of unit length. If the bits are not a rotation, returns false and sets
// `rotation` to the identity: bit 47 is set, a 15-bit value is 32767, or the three components have
// a sum of squares above 1.
[[nodiscard]] bool UnpackQuat(const PackedQuat& packed, Quat& rotation);

// Convert an offset in [-range, range] to and from a 16-bit integer i = round(32767 * value /
// range). Other offsets are clamped. Error: at most range / 65534. A range of 0 gives 0.
[[nodiscard]] std::int16_t PackOffset(float value, float range);
[[nodiscard]] float UnpackOffset(std::int16_t packed, float range);

// Convert a coefficient in (-2, 2) to and from a 16-bit integer i = round(16384 * value). Other
// coefficients are clamped. 0 and 1 are exact. Error: at most 1/32768.
[[nodiscard]] std::int16_t PackBlendShape(float value);
[[nodiscard]] float UnpackBlendShape(std::int16_t packed);

// Convert a weight in [0, 1] to and from an 8-bit integer i = round(255 * value). Other weights are
// clamped. Error: at most 1/510.
[[nodiscard]] std::uint8_t PackWeight(float value);
[[nodiscard]] float UnpackWeight(std::uint8_t packed);

}  // namespace furrow::protocol
