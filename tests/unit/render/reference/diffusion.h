// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/skin/skin_profile.h"
#include "tests/unit/render/reference/float_picture.h"

namespace furrow::render::test {

// Light that leaves a flat card of skin: the radial profile convolved with `irradiance`, whose
// pixels are squares of `mm_per_pixel`. Skin is where alpha is above 0.5; light neither enters nor
// leaves elsewhere, and what the profile would send there is given back in proportion. Exact: the
// profile is a sum of Gaussians, each of which is convolved along x, then y, with its integral over
// a pixel.
[[nodiscard]] FloatPicture Diffuse(const SkinProfile& profile, const FloatPicture& irradiance,
                                   double mm_per_pixel);

// The same for one pixel by plain summation of the radial profile over the others, each divided
// into `subdivisions` x `subdivisions` points: slow, and made of nothing but RadialProfile().
[[nodiscard]] glm::dvec3 DiffuseBySum(const SkinProfile& profile, const FloatPicture& irradiance,
                                      double mm_per_pixel, int x, int y, int subdivisions);

}  // namespace furrow::render::test
