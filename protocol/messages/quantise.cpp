// SPDX-License-Identifier: Apache-2.0
#include "protocol/messages/quantise.h"

#include <algorithm>
#include <cmath>

namespace furrow::protocol {
namespace {

constexpr float kSqrt2 = 1.41421356f;
constexpr int kQuatSteps = 32766;  // even, so that 0 has an exact code
constexpr int kOffsetSteps = 32767;
constexpr float kBlendShapeSteps = 16384.0f;

// Maps [-1/sqrt(2), 1/sqrt(2)] to the codes 0 to 32766.
std::uint64_t PackComponent(float value) {
  const float scaled = std::round((value * kSqrt2 + 1.0f) * 0.5f * kQuatSteps);
  return static_cast<std::uint64_t>(std::clamp(scaled, 0.0f, static_cast<float>(kQuatSteps)));
}

// Counts steps from the middle code: the middle decodes to exactly 0, and there is no division.
float UnpackComponent(std::uint64_t code) {
  constexpr float kStep = 2.0f / (static_cast<float>(kQuatSteps) * kSqrt2);
  return static_cast<float>(static_cast<int>(code) - kQuatSteps / 2) * kStep;
}

}  // namespace

PackedQuat PackQuat(const Quat& rotation) {
  const std::array<float, 4> q = {rotation.x, rotation.y, rotation.z, rotation.w};
  std::size_t largest = 0;
  float length_squared = 0.0f;
  for (std::size_t i = 0; i < 4; ++i) {
    length_squared += q[i] * q[i];
    if (std::fabs(q[i]) > std::fabs(q[largest])) largest = i;
  }
  // q and -q are the same rotation. A positive largest component needs no sign on the wire.
  const float scale = (q[largest] < 0.0f ? -1.0f : 1.0f) / std::sqrt(length_squared);
  std::uint64_t bits = static_cast<std::uint64_t>(largest) << 45;
  int shift = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (i == largest) continue;
    bits |= PackComponent(q[i] * scale) << shift;
    shift += 15;
  }
  return {static_cast<std::uint16_t>(bits), static_cast<std::uint16_t>(bits >> 16),
          static_cast<std::uint16_t>(bits >> 32)};
}

// The most frequent call of the hot path, therefore without loops and without an indexed array.
bool UnpackQuat(const PackedQuat& packed, Quat& rotation) {
  rotation = Quat{};
  const std::uint64_t bits = packed[0] | static_cast<std::uint64_t>(packed[1]) << 16 |
                             static_cast<std::uint64_t>(packed[2]) << 32;
  const std::uint64_t first = bits & 0x7FFF;
  const std::uint64_t second = bits >> 15 & 0x7FFF;
  const std::uint64_t third = bits >> 30 & 0x7FFF;
  if (bits >> 47 != 0 || std::max({first, second, third}) > kQuatSteps) return false;
  const float a = UnpackComponent(first);
  const float b = UnpackComponent(second);
  const float c = UnpackComponent(third);
  const float sum = a * a + b * b + c * c;
  // No unit quaternion has such components.
  if (sum > 1.0f) return false;
  const float largest = std::sqrt(1.0f - sum);
  switch (bits >> 45) {
    case 0: rotation = {largest, a, b, c}; break;
    case 1: rotation = {a, largest, b, c}; break;
    case 2: rotation = {a, b, largest, c}; break;
    default: rotation = {a, b, c, largest}; break;
  }
  return true;
}

std::int16_t PackOffset(float value, float range) {
  // All offsets are 0 then; the division would give NaN.
  if (!(range > 0.0f)) return 0;
  const float scaled = std::round(std::clamp(value / range, -1.0f, 1.0f) * kOffsetSteps);
  return static_cast<std::int16_t>(scaled);
}

float UnpackOffset(std::int16_t packed, float range) {
  return range * (static_cast<float>(packed) / kOffsetSteps);
}

std::int16_t PackBlendShape(float value) {
  constexpr float kLimit = 32767.0f;
  return static_cast<std::int16_t>(
      std::clamp(std::round(value * kBlendShapeSteps), -kLimit, kLimit));
}

float UnpackBlendShape(std::int16_t packed) {
  return static_cast<float>(packed) / kBlendShapeSteps;
}

std::uint8_t PackWeight(float value) {
  return static_cast<std::uint8_t>(std::round(std::clamp(value, 0.0f, 1.0f) * 255.0f));
}

float UnpackWeight(std::uint8_t packed) { return static_cast<float>(packed) / 255.0f; }

}  // namespace furrow::protocol
