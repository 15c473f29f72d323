// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "protocol/messages/messages.h"
#include "server/pipeline/stream_definition.h"
#include "wrinkle/skeleton/pose.h"

namespace furrow::server {

// The one place where the wire's structs become the algorithm's. Both sides are verified: protocol/
// has checked counts, finite numbers and unit quaternions before anything comes here.

[[nodiscard]] StreamOffer ToStreamOffer(const protocol::SkeletonOffer& offer);

// True when the frame's counts and indices are the stream's.
[[nodiscard]] bool PoseFits(const protocol::PoseFrame& frame, const StreamDefinition& stream);

// Fills `pose` (sized for `stream`) from a frame that fits: what the frame leaves out rests, or
// stays as it is where the frame is partial. Does not allocate.
void ApplyPose(const protocol::PoseFrame& frame, const StreamDefinition& stream,
               wrinkle::LocalPose* pose);

// The other way: the whole pose, in the wire's order of joints. What is at rest is left out but for
// rotations. The skeleton's hash is the caller's to fill in. Reuses `frame`'s memory.
void ToWholePose(const wrinkle::LocalPose& pose, const StreamDefinition& stream,
                 protocol::PoseFrame* frame);

}  // namespace furrow::server
