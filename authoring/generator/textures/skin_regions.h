// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "authoring/paint/surface_texels.h"

namespace furrow::authoring {

// Helpers to place features on the skin. Points are in head space, centimetres.

// How much of a point is red of the lips, [0, 1].
[[nodiscard]] float LipShare(const glm::vec3& p);
// A bell over an ellipsoid: 1 at the centre, 1/e at one radius.
[[nodiscard]] float Spot(const glm::vec3& p, const glm::vec3& centre, const glm::vec3& radii);
// The point itself or, from the right side, its mirror image on the left side (x >= 0).
[[nodiscard]] glm::vec3 OnLeftSide(const glm::vec3& p);
// Whether a texel of the skin shows a hand. Hands share the atlas of the head.
[[nodiscard]] bool OnHand(const SurfaceTexel& texel);

}  // namespace furrow::authoring
