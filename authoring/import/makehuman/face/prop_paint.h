// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "authoring/paint/surface_texels.h"
#include "character/character.h"

namespace furrow::authoring {

// The angle from the line of sight to the edge of the picture of PaintEye(), radians. 1.75 is just
// over a quarter turn, so the picture covers the visible half of the eyeball.
inline constexpr float kEyePictureAngle = 1.75f;
// An eyeball seen from the front, 8-bit sRGB, with the pupil in the centre of the picture. The
// distance of a texel from the centre is proportional to the angle from the line of sight. `size`:
// width and height, texels.
[[nodiscard]] character::Picture PaintEye(int size);

// Cloth, 8-bit sRGB: trousers below the height `waist` (model space, metres), a shirt above, and a
// subtle weave. `texels`: those that the garment covers.
[[nodiscard]] character::Picture PaintCloth(const std::vector<SurfaceTexel>& texels, float waist,
                                            int size);

// The weave as a tangent-space normal map, 8 bits, green up.
[[nodiscard]] character::Picture PaintWeaveNormals(const std::vector<SurfaceTexel>& texels,
                                                   int size);

}  // namespace furrow::authoring
