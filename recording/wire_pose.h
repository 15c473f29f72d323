// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "motion/clip/clip.h"
#include "protocol/messages/messages.h"

namespace furrow::recording {

// A clip's skeleton as the wire offers it.
[[nodiscard]] protocol::SkeletonOffer OfferOf(const motion::Clip& clip, const std::string& subject,
                                              float metres_per_unit);

// Frame `frame` of the clip as a whole pose: rotations of all joints, translations and scales of
// those that leave their rest. Reuses `pose`'s memory.
void FillPose(const motion::Clip& clip, int frame, protocol::PoseFrame* pose);

}  // namespace furrow::recording
