// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "protocol/messages/messages.h"
#include "server/pipeline/stream_definition.h"
#include "wrinkle/skeleton/pose.h"

namespace furrow::server {

// Functions that convert the structs of the protocol to those of the solver and back. Precondition:
// the codec has checked the inputs (counts, finite numbers, unit quaternions).

// Converts a skeleton offer.
[[nodiscard]] StreamOffer ToStreamOffer(const protocol::SkeletonOffer& offer);

// True if the counts and indices of the frame match the stream.
[[nodiscard]] bool PoseFits(const protocol::PoseFrame& frame, const StreamDefinition& stream);

// Fills `pose`, which is sized for `stream`, from a frame that fits. Values that the frame lacks
// are set to rest, or stay unchanged if the frame is partial. Does not allocate.
void ApplyPose(const protocol::PoseFrame& frame, const StreamDefinition& stream,
               wrinkle::LocalPose* pose);

// Sets `frame` to a whole pose in the joint order of the wire: all rotations, and the translations
// and scales that differ from rest. The caller sets the skeleton hash. Reuses the memory of
// `frame`.
void ToWholePose(const wrinkle::LocalPose& pose, const StreamDefinition& stream,
                 protocol::PoseFrame* frame);

}  // namespace furrow::server
