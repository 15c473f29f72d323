// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "protocol/codec/codec.h"

// Messages for several tests.
namespace furrow::protocol::test {

inline constexpr Header kHeader{0xfeedULL, 7, 11, 123'456'789};

// Makes a chain of joints with tails and blend shapes.
[[nodiscard]] SkeletonOffer MakeOffer(int num_joints, int num_blend_shapes);

// Makes a random pose of that skeleton: all rotations, translations within 5 cm, blend shapes.
[[nodiscard]] PoseFrame MakePose(int num_joints, int num_blend_shapes, std::uint32_t seed);

// Makes the state of a subject with that skeleton, with a pose, a neutral pose and two driver
// values.
[[nodiscard]] SubjectState MakeState(int num_joints, int num_blend_shapes);

// Angle between two rotations in radians. The distance of unit quaternions is more accurate than
// the arc cosine for small angles.
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

// What a receiver says of `message` after `change(message)`.
template <class Message, class Change, class... Options>
[[nodiscard]] DecodeStatus DecodeChanged(Message message, const Change& change,
                                         const Options&... options) {
  change(message);
  Message out;
  return OpenAndDecode(Encoded(message, options...), out);
}

}  // namespace furrow::protocol::test
