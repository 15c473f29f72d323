// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "protocol/messages/messages.h"
#include "wrinkle/skeleton/skeleton.h"

// From the structs of the protocol to those of the solver. The daemon and the reader of takes share
// these functions, so that both give the same weights for a take. Precondition: the codec has
// checked the messages (counts, finite numbers, unit quaternions).
namespace furrow::recording {

// The joints of an offer, in its order. `scale`: a factor for all lengths.
[[nodiscard]] std::vector<wrinkle::JointDesc> JointsOf(const protocol::SkeletonOffer& offer,
                                                       float scale = 1.0f);

// Where the values of a stream's poses belong.
struct WireTarget {
  std::span<const wrinkle::Transform> rest;     // the skeleton's rest pose
  std::span<const std::int16_t> joint_of_wire;  // per joint of the offer: its skeleton index
  float scale = 1.0f;                           // a factor for all lengths
};

// Sets a pose of the skeleton, and its blend shapes in the stream's order, from a frame whose
// indices fit. Values that the frame lacks are set to rest, or stay unchanged if the frame is
// partial. Does not allocate.
void ApplyWirePose(const protocol::PoseFrame& frame, const WireTarget& target,
                   std::span<wrinkle::Transform> joints, std::span<float> blend_shapes);

}  // namespace furrow::recording
