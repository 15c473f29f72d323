// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "protocol/messages/limits.h"

namespace furrow::protocol::bench {

// What a program does that trusts its peer: FlatBuffers' own verifier with its own limits, then
// every field as it lies, packed ones packed. No number is looked at.
struct PlainPose {
  std::uint64_t skeleton_hash = 0;
  int num_joints = 0;
  float translation_range = 0.0f;
  std::array<std::array<float, 4>, kMaxJoints> rotations;
  std::array<std::array<std::uint16_t, 3>, kMaxJoints> packed_rotations;
  std::array<std::array<float, 3>, kMaxJoints> translations;
  std::array<std::array<std::int16_t, 3>, kMaxJoints> packed_translations;
  std::array<std::uint8_t, kMaxJoints / 8> rotation_mask;
  std::array<std::uint8_t, kMaxJoints / 8> translation_mask;
};

struct PlainWeights {
  std::uint64_t names_hash = 0;
  std::int64_t age_us = 0;
  std::array<float, kMaxWeights> values;
  std::array<std::uint8_t, kMaxWeights> packed_values;
};

// `payload`: at a multiple of 8, of at most as many values as there is room for. False where the
// verifier says no.
[[nodiscard]] bool ReadPlainly(std::span<const std::uint8_t> payload, PlainPose& pose);
[[nodiscard]] bool ReadPlainly(std::span<const std::uint8_t> payload, PlainWeights& weights);

// The verifier alone.
[[nodiscard]] bool VerifyPlainly(std::span<const std::uint8_t> pose_payload);

}  // namespace furrow::protocol::bench
