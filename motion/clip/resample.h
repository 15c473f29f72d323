// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "motion/clip/clip.h"

namespace furrow::motion {

// Resamples a clip at evenly spaced times from its first frame to its last, which may move by half
// a step. Translations, scales and blend shapes are interpolated linearly, rotations by slerp.
//
// `rate` is in Hz and greater than 0. A clip of fewer than two frames is returned unchanged.
[[nodiscard]] Clip Resample(const Clip& clip, double rate);

// Returns true if every frame is within a hundredth of a step of even spacing.
[[nodiscard]] bool IsEvenlySpaced(const Clip& clip);
// The mean time between frames in seconds; 0 for fewer than two frames.
[[nodiscard]] double MeanFrameTime(const Clip& clip);

}  // namespace furrow::motion
