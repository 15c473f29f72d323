// SPDX-License-Identifier: Apache-2.0
#include "client/plan/message_sizes.h"

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "protocol/codec/codec.h"
#include "protocol/framing/fragment.h"
#include "protocol/secure/packet/packet.h"

namespace furrow::plan {
namespace {

// UDP and IPv4; Ethernet with its preamble, checksum and gap.
constexpr std::size_t kHeaderBytes = 28 + 38;

MessageSize SizeOf(const std::vector<std::uint8_t>& message, const Demand& demand) {
  const std::size_t count = protocol::NumDatagrams(message.size());
  const std::size_t sealed = demand.is_sealed ? protocol::secure::kPacketOverheadBytes : 0;
  // Each datagram but one repeats the envelope, and fragments have headers of their own.
  const std::size_t fragments =
      count == 1 ? 0
                 : (count - 1) * protocol::kEnvelopeBytes + count * protocol::kFragmentHeaderBytes;
  const std::size_t bytes = message.size() + fragments + count * (kHeaderBytes + sealed);
  return {static_cast<int>(count), static_cast<double>(bytes)};
}

template <class Index>
std::vector<Index> FirstNumbers(int count) {
  std::vector<Index> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), Index{0});
  return numbers;
}

}  // namespace

MessageSize PoseSize(const Demand& demand) {
  protocol::PoseFrame pose;
  pose.skeleton_hash = 1;
  pose.num_joints = static_cast<std::uint16_t>(demand.joints);
  pose.rotation_joints = FirstNumbers<std::uint16_t>(demand.joints);
  pose.rotations.resize(pose.rotation_joints.size());
  if (demand.joints > 0) {
    pose.translation_joints = {0};
    pose.translations.resize(1);
  }
  pose.num_blend_shapes = static_cast<std::uint16_t>(demand.blend_shapes);
  pose.blend_shape_indices = FirstNumbers<std::uint16_t>(demand.blend_shapes);
  pose.blend_shapes.resize(pose.blend_shape_indices.size(), 0.5f);
  std::vector<std::uint8_t> message;
  protocol::Encoder().Encode(
      {.session = 1}, pose, message,
      demand.floats ? protocol::PoseEncoding() : protocol::PoseEncoding::Small());
  return SizeOf(message, demand);
}

MessageSize WeightsSize(const Demand& demand) {
  protocol::WeightFrame frame;
  frame.names_hash = 1;  // 0 would be left out
  frame.format = demand.u8 ? protocol::WeightFormat::kU8 : protocol::WeightFormat::kF32;
  frame.values.resize(static_cast<std::size_t>(demand.weights), 0.5f);
  std::vector<std::uint8_t> message;
  protocol::Encoder().Encode({.session = 1}, frame, message);
  return SizeOf(message, demand);
}

}  // namespace furrow::plan
