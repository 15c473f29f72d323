// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "render/skin/skin_profile.h"

namespace furrow::render {

// One side of a kernel on a grid of pixels that is run along x and then, turned by 90 degrees,
// along y. The pixel itself first, then outwards; the other side are the same taps at the offsets'
// negatives. The weights' sum over [0] once and the others twice is 1 per channel.
struct PixelTaps {
  std::vector<glm::vec2> offsets;  // whole pixels; x: along the axis, rising; y: across it
  std::vector<glm::vec3> weights;  // as many, none negative
};

inline constexpr int kMinSeparableTaps = 5;
inline constexpr int kMaxSeparableTaps = 41;

// The separable kernel (after Jimenez et al. 2015) for pixels of 1 / `pixels_per_mm` mm.
//
// Along its axis, what a kernel makes of a straight edge is a staircase, a step at each tap. Taps
// and weights are those of the staircase that comes nearest to the profile's StepResponse(): no
// other ones on whole pixels come nearer, in squares over all pixels and channels, each of which
// counts for 1 + 2 x, x millimetres from the edge. Across the axis a tap stands aside by a fifth of
// the way from the one before, so that an edge meets 121 different distances with 11 taps and not
// 11: the other axis' pass smooths the steps of this one.
//
// A flat field stays flat. Where pixels are wide the kernel gets short, down to a single tap; where
// all pixels within reach have taps it is exact, and straight. `taps`, of both sides and the pixel:
// odd, in [kMinSeparableTaps, kMaxSeparableTaps]; other values are taken to the nearest. Takes some
// tens of microseconds at most.
[[nodiscard]] PixelTaps PixelKernel(const SkinProfile& profile, int taps, float pixels_per_mm);

// A Gaussian of `sigma` pixels: seven taps on the axis, a standard deviation apart, with the
// variance that is asked for. One tap where it is below a third of a pixel.
[[nodiscard]] PixelTaps PixelGaussian(float sigma);

}  // namespace furrow::render
