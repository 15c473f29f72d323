// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "motion/clip/clip.h"

namespace furrow::motion {

// The clip at evenly spaced times from its first to its last (the last is met within half a step):
// translations, scales and blend shapes linear between frames, rotations by slerp.
//
// `rate` in Hz, above 0; a clip of fewer than two frames comes back as it is.
[[nodiscard]] Clip Resample(const Clip& clip, double rate);

// True where the clip's frames are evenly spaced to a hundredth of their distance.
[[nodiscard]] bool IsEvenlySpaced(const Clip& clip);
// Mean distance of the frames in seconds; 0 for fewer than two.
[[nodiscard]] double MeanFrameTime(const Clip& clip);

}  // namespace furrow::motion
