// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/skin/skin_profile.h"
#include "tests/unit/render/reference/float_picture.h"

namespace furrow::render::test {

// Light that leaves a flat card of skin: the radial profile convolved with `irradiance`, which has
// square pixels of `mm_per_pixel`. Skin is where alpha is above 0.5. Light neither enters nor
// leaves elsewhere, and the share that the profile sends there is redistributed in proportion. The
// result is exact: the profile is a sum of Gaussians, and each Gaussian, integrated over a pixel,
// is convolved along x and then y.
[[nodiscard]] FloatPicture Diffuse(const SkinProfile& profile, const FloatPicture& irradiance,
                                   double mm_per_pixel);

// The same for one pixel, as a plain sum of the radial profile over all other pixels, each divided
// into `subdivisions` x `subdivisions` points. Slow, and independent of everything but
// RadialProfile().
[[nodiscard]] glm::dvec3 DiffuseBySum(const SkinProfile& profile, const FloatPicture& irradiance,
                                      double mm_per_pixel, int x, int y, int subdivisions);

}  // namespace furrow::render::test
