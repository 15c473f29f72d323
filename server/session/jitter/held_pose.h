// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "protocol/framing/envelope.h"
#include "protocol/messages/messages.h"
#include "server/core/time.h"

namespace furrow::server {

// A pose that waits in a jitter buffer.
struct HeldPose {
  protocol::Header header;
  protocol::PoseFrame pose;
  std::vector<std::uint8_t> payload;  // the FlatBuffers buffer; empty: not a whole pose
  Time due{0};

  // The memory that the pose takes, bytes.
  [[nodiscard]] std::size_t bytes() const {
    const auto of = [](const auto& list) { return list.capacity() * sizeof(list[0]); };
    return sizeof(HeldPose) + of(payload) + of(pose.previous) + of(pose.rotation_joints) +
           of(pose.rotations) + of(pose.translation_joints) + of(pose.translations) +
           of(pose.scale_joints) + of(pose.scales) + of(pose.blend_shape_indices) +
           of(pose.blend_shapes);
  }
};

}  // namespace furrow::server
