// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "protocol/messages/limits.h"

namespace furrow::protocol::bench {

// The baseline: a program that trusts its peer. It runs the FlatBuffers verifier with default
// limits and copies every field as stored. It neither unpacks nor checks numbers.
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

// `payload` must be aligned to 8 bytes and have no more values than the target has room for.
// Returns false if the verifier rejects it.
[[nodiscard]] bool ReadPlainly(std::span<const std::uint8_t> payload, PlainPose& pose);
[[nodiscard]] bool ReadPlainly(std::span<const std::uint8_t> payload, PlainWeights& weights);

// Runs only the verifier.
[[nodiscard]] bool VerifyPlainly(std::span<const std::uint8_t> pose_payload);

}  // namespace furrow::protocol::bench
