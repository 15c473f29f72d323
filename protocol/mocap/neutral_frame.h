// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "protocol/messages/messages.h"

namespace furrow::protocol::mocap {

struct NeutralJoint {
  std::string name;       // as the sender calls it
  int parent = -1;        // index of an earlier joint of the same frame; -1 for a root
  Vec3 translation;       // local, metres
  Quat rotation;          // local, unit
  Vec3 rest_translation;  // local, metres; does not change while NeutralFrame::layout stands
};

struct NeutralBlendShape {
  std::string name;  // as the sender spells it (VMC: as first seen)
  float value = 0.0f;
};

// One subject at one instant, whatever wire it came by: right-handed, Y up, +Z forward, metres.
struct NeutralFrame {
  std::string subject;
  std::int64_t capture_time_us = 0;  // the sender's clock where it has one, else arrival
  std::uint32_t sequence = 0;        // counts the frames of this subject from 0, by the adapter
  // Changes whenever the names, parents or order of joints
  // and blend shapes do: offer a skeleton anew.
  std::uint32_t layout = 0;
  bool tracked = true;  // false: the sender says it lost the subject; values are its last
  std::vector<NeutralJoint> joints;
  std::vector<NeutralBlendShape> blend_shapes;
};

// The skeleton that such a frame implies; rest rotations are identity (foreign wires send none).
[[nodiscard]] SkeletonOffer MakeOffer(const NeutralFrame& frame);

// The pose of `frame` against an offer made from a frame of
// the same layout. Reuses `pose`'s memory.
void MakePose(const NeutralFrame& frame, const SkeletonOffer& offer, PoseFrame& pose);

}  // namespace furrow::protocol::mocap
