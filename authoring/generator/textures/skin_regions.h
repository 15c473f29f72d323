// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "authoring/paint/surface_texels.h"

namespace furrow::authoring {

// Helpers to place features on the skin. Points are in head space, centimetres.

// How much the point `p` belongs to the red of the lips, 0 skin to 1 lips.
[[nodiscard]] float LipShare(const glm::vec3& p);
// How near a point is to the opening of its eye, by its place `eye` relative to the eye's centre: 0
// beyond the corners and behind the eyeball.
[[nodiscard]] float NearLids(const glm::vec3& eye);
// A bell curve around `centre`: 1 there, 1/e on the ellipsoid with the radii `radii`.
[[nodiscard]] float Spot(const glm::vec3& p, const glm::vec3& centre, const glm::vec3& radii);
// Returns `p` mirrored to the left side: x becomes |x|.
[[nodiscard]] glm::vec3 OnLeftSide(const glm::vec3& p);
// True if a texel of the skin shows a hand. Hands share the UV atlas of the head.
[[nodiscard]] bool OnHand(const SurfaceTexel& texel);

}  // namespace furrow::authoring
