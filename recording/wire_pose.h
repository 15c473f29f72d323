// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "motion/clip/clip.h"
#include "protocol/messages/messages.h"

namespace furrow::recording {

// A clip's skeleton as a wire message. `metres_per_unit` is the clip's unit of length.
[[nodiscard]] protocol::SkeletonOffer OfferOf(const motion::Clip& clip, const std::string& subject,
                                              float metres_per_unit);

// Converts a frame of a clip to a complete (not partial) wire pose: the rotations of all joints,
// and the translations and scales that differ from the rest pose. Reuses `pose`'s memory.
void FillPose(const motion::Clip& clip, int frame, protocol::PoseFrame* pose);

}  // namespace furrow::recording
