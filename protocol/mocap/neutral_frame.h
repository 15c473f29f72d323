// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/time/timecode.h"
#include "protocol/messages/messages.h"

namespace furrow::protocol::mocap {

// A joint of a NeutralFrame, with its pose in that frame.
struct NeutralJoint {
  std::string name;       // in the sender's spelling
  int parent = -1;        // index of an earlier joint of the same frame; -1 for a root
  Vec3 translation;       // local, metres
  Quat rotation;          // local, unit length
  Vec3 rest_translation;  // local, metres; constant for one NeutralFrame::layout
};

struct NeutralBlendShape {
  std::string name;  // in the sender's spelling (VMC: the first spelling received)
  float value = 0.0f;
};

// One subject at one instant, independent of the source protocol. Right-handed, Y up, +Z forward,
// metres.
struct NeutralFrame {
  std::string subject;
  std::int64_t capture_time_us = 0;  // on the sender's clock if it has one, otherwise arrival time
  std::uint32_t sequence = 0;        // the adapter counts the frames of this subject from 0
  // Changes whenever names, parents or the order of joints or blend shapes change. Each layout
  // needs its own skeleton offer.
  std::uint32_t layout = 0;
  std::optional<Timecode> timecode;  // of the sender, if it sends one
  bool tracked = true;  // false: the sender lost the subject; the values are the last ones
  std::vector<NeutralJoint> joints;
  std::vector<NeutralBlendShape> blend_shapes;
};

// Makes the skeleton offer for the layout of a frame. Rest rotations are the identity, because
// foreign protocols send none.
[[nodiscard]] SkeletonOffer MakeOffer(const NeutralFrame& frame);

// Converts a frame to a complete wire pose for `offer`, which MakeOffer() made from a frame of the
// same subject and layout. Replaces the content of `pose` and reuses its memory.
void MakePose(const NeutralFrame& frame, const SkeletonOffer& offer, PoseFrame& pose);

}  // namespace furrow::protocol::mocap
