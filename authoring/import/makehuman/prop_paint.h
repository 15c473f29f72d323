// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "authoring/paint/surface_texels.h"
#include "character/character.h"

namespace furrow::authoring {

// An eyeball seen from the front, 8-bit sRGB: the picture's centre is the pupil, and distance from
// it is the angle from the axis of sight, half the picture's width being kEyePictureAngle.
inline constexpr float kEyePictureAngle = 1.75f;  // radians
[[nodiscard]] character::Picture PaintEye(int size);

// 8-bit sRGB cloth: trousers below `waist` (model space, metres), a shirt above, a subtle weave.
[[nodiscard]] character::Picture PaintCloth(const std::vector<SurfaceTexel>& texels, float waist,
                                            int size);

// Tangent-space normal map of the weave, 8 bits, green up.
[[nodiscard]] character::Picture PaintWeaveNormals(const std::vector<SurfaceTexel>& texels,
                                                   int size);

}  // namespace furrow::authoring
