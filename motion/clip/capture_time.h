// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "motion/clip/clip.h"

namespace furrow::motion {

// The capture time of a frame in whole microseconds, as it is sent on the wire.
[[nodiscard]] inline std::int64_t CaptureTimeUs(const Clip& clip, int frame) {
  return std::llround(clip.times[static_cast<std::size_t>(frame)] * 1e6);
}

// Seconds from the frame before to `frame`, from their capture times; 0 for frame 0. The daemon
// sees the same step, so a solver that uses it has the daemon's results to the bit.
[[nodiscard]] inline double CaptureStep(const Clip& clip, int frame) {
  if (frame == 0) return 0.0;
  return static_cast<double>(CaptureTimeUs(clip, frame) - CaptureTimeUs(clip, frame - 1)) * 1e-6;
}

}  // namespace furrow::motion
