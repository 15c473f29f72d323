// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "render/skin/skin_profile.h"

namespace furrow::render {

// One side of a kernel on a grid of pixels. The kernel runs along x and then, rotated by 90
// degrees, along y. The centre comes first, then taps at increasing distance. The other side has
// the same taps at negated offsets. Per channel, weights[0] plus twice the other weights is 1.
struct PixelTaps {
  std::vector<glm::vec2> offsets;  // whole pixels; x: along the axis, ascending; y: across it
  std::vector<glm::vec3> weights;  // one per offset, none negative
};

inline constexpr int kMinSeparableTaps = 5;
inline constexpr int kMaxSeparableTaps = 41;

// The separable kernel (after Jimenez et al. 2015) for pixels of 1 / `pixels_per_mm` mm.
//
// Along its axis, a kernel turns a straight edge into a staircase with a step at each tap. The taps
// and weights minimise the squared difference between this staircase and the profile's
// StepResponse(), summed over all pixels and channels; a pixel at x mm from the edge has the weight
// 1 + 2 x. Across the axis, each tap is shifted by a fifth of the distance from the tap before it.
// With 11 taps, an edge thus meets 121 different distances and not 11, and the other axis' pass
// smooths the steps of this one.
//
// A uniform area stays uniform. Where pixels are wide, the kernel gets shorter, down to a single
// tap. Where there are taps for all pixels within reach, the kernel is exact and not shifted.
// `taps` counts both sides and the centre: odd, in [kMinSeparableTaps, kMaxSeparableTaps]; other
// values are rounded to the nearest valid one. Takes tens of microseconds at most.
[[nodiscard]] PixelTaps PixelKernel(const SkinProfile& profile, int taps, float pixels_per_mm);

// A Gaussian of `sigma` pixels: seven taps on the axis, one standard deviation apart, with exactly
// the requested variance. A single tap if `sigma` is below a third of a pixel.
[[nodiscard]] PixelTaps PixelGaussian(float sigma);

}  // namespace furrow::render
