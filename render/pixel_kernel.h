// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec4.hpp>

#include "render/skin_profile.h"

namespace furrow::render {

// One side of SeparableKernel() on a grid of pixels: rgb: weight, w: offset in whole pixels. The
// pixel itself first, then outwards; sum over [0] once and the others twice is 1 per channel.
//
// The taps' places are SeparableKernel()'s, moved to whole pixels of their own, so that each is one
// texel and no two are the same; the weights are the profile's integrals over what lies nearest to
// each, so that a flat field stays flat and a straight edge keeps its response. Where a pixel is
// wide the kernel gets short, down to a single tap.
[[nodiscard]] std::vector<glm::vec4> PixelKernel(const SkinProfile& profile, int taps,
                                                 float pixels_per_mm);

// A Gaussian of `sigma` pixels in the same layout: seven taps, a standard deviation apart, with the
// variance that is asked for. One tap where it is below a third of a pixel.
[[nodiscard]] std::vector<glm::vec4> PixelGaussian(float sigma);

}  // namespace furrow::render
