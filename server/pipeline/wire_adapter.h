// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "protocol/messages/messages.h"
#include "server/pipeline/stream_definition.h"
#include "wrinkle/skeleton/pose.h"

namespace furrow::server {

// Converts the structs of the wire to those of the algorithm and back. Inputs are verified: the
// codec has checked counts, finite numbers and unit quaternions.

[[nodiscard]] StreamOffer ToStreamOffer(const protocol::SkeletonOffer& offer);

// True if the counts and indices of the frame match the stream.
[[nodiscard]] bool PoseFits(const protocol::PoseFrame& frame, const StreamDefinition& stream);

// Fills `pose`, which is sized for `stream`, from a frame that fits. Values that the frame lacks
// are at rest, or keep their values if the frame is partial. Does not allocate.
void ApplyPose(const protocol::PoseFrame& frame, const StreamDefinition& stream,
               wrinkle::LocalPose* pose);

// Writes a whole pose in the joint order of the wire: all rotations, and the translations and
// scales that differ from rest. The caller sets the skeleton hash. Reuses the memory of `frame`.
void ToWholePose(const wrinkle::LocalPose& pose, const StreamDefinition& stream,
                 protocol::PoseFrame* frame);

}  // namespace furrow::server
