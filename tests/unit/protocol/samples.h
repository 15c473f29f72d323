// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "protocol/codec/codec.h"

// Messages that several tests use.
namespace furrow::protocol::test {

inline constexpr Header kHeader{0xfeedULL, 7, 11, 123'456'789};

// A chain of joints with tails and blend shapes.
[[nodiscard]] SkeletonOffer MakeOffer(int num_joints, int num_blend_shapes);

// A pose of that skeleton from a seed: all rotations, all translations within 5 cm, all shapes.
[[nodiscard]] PoseFrame MakePose(int num_joints, int num_blend_shapes, std::uint32_t seed);

// Radians between two rotations; the distance of unit quaternions keeps digits that a cosine loses.
[[nodiscard]] double AngleBetween(const Quat& a, const Quat& b);

template <class Message, class... Options>
[[nodiscard]] std::vector<std::uint8_t> Encoded(const Message& message, const Options&... options) {
  Encoder encoder;
  std::vector<std::uint8_t> bytes;
  encoder.Encode(kHeader, message, bytes, options...);
  return bytes;
}

template <class Message>
[[nodiscard]] DecodeStatus OpenAndDecode(std::span<const std::uint8_t> bytes, Message& message) {
  MessageView view;
  const DecodeStatus status = OpenMessage(bytes, view);
  return status == DecodeStatus::kOk ? Decode(view, message) : status;
}

}  // namespace furrow::protocol::test
