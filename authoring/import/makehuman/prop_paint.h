// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "authoring/paint/surface_texels.h"
#include "character/character.h"

namespace furrow::authoring {

// An eyeball seen from the front, 8-bit sRGB. The pupil is in the centre of the picture. The
// distance from it is the angle from the line of sight; half the picture's width is
// kEyePictureAngle.
inline constexpr float kEyePictureAngle = 1.75f;  // radians
[[nodiscard]] character::Picture PaintEye(int size);

// Cloth, 8-bit sRGB: trousers below `waist` (model space, metres), a shirt above, a subtle weave.
[[nodiscard]] character::Picture PaintCloth(const std::vector<SurfaceTexel>& texels, float waist,
                                            int size);

// The weave as a tangent-space normal map, 8 bits, green up.
[[nodiscard]] character::Picture PaintWeaveNormals(const std::vector<SurfaceTexel>& texels,
                                                   int size);

}  // namespace furrow::authoring
