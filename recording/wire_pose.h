// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "motion/clip/clip.h"
#include "protocol/messages/messages.h"

namespace furrow::recording {

// Makes the offer of a clip's skeleton and blend shapes. `metres_per_unit`: the clip's unit of
// length.
[[nodiscard]] protocol::SkeletonOffer OfferOf(const motion::Clip& clip, const std::string& subject,
                                              float metres_per_unit);

// Converts frame `frame`, in [0, clip.num_frames()), to a complete (not partial) wire pose: the
// rotations of all joints, the translations and scales that differ from the rest pose, and the
// blend shapes, and the timecode if there is one. Replaces the content of `pose` and reuses its
// memory.
void FillPose(const motion::Clip& clip, int frame, protocol::PoseFrame* pose);

}  // namespace furrow::recording
