// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "protocol/codec/codec.h"

namespace furrow::chaos {

using Packet = std::vector<std::uint8_t>;

inline Packet Weights(std::uint32_t sequence, std::vector<float> values) {
  Packet packet;
  protocol::Encoder().Encode({.session = 5, .stream = 1, .sequence = sequence},
                             protocol::WeightFrame{.names_hash = 9, .values = std::move(values)},
                             packet);
  return packet;
}

inline std::vector<float> ValuesOf(const Packet& packet, std::uint32_t* sequence) {
  protocol::MessageView view;
  protocol::WeightFrame frame;
  EXPECT_EQ(protocol::OpenMessage(packet, view), protocol::DecodeStatus::kOk);
  EXPECT_EQ(protocol::Decode(view, frame), protocol::DecodeStatus::kOk);
  *sequence = view.header.sequence;
  return frame.values;
}

// Each joint has a different rotation.
inline protocol::PoseFrame WholeBody(int joints) {
  protocol::PoseFrame pose{.skeleton_hash = 1, .num_joints = static_cast<std::uint16_t>(joints)};
  for (int i = 0; i < joints; ++i) {
    pose.rotation_joints.push_back(static_cast<std::uint16_t>(i));
    const float turn = 0.02f * static_cast<float>(i);
    pose.rotations.push_back({0.0f, std::sin(turn), 0.0f, std::cos(turn)});
  }
  return pose;
}

inline protocol::PoseFrame PoseOf(const Packet& packet) {
  protocol::MessageView view;
  protocol::PoseFrame frame;
  EXPECT_EQ(protocol::OpenMessage(packet, view), protocol::DecodeStatus::kOk);
  EXPECT_EQ(protocol::Decode(view, frame), protocol::DecodeStatus::kOk);
  return frame;
}

}  // namespace furrow::chaos
