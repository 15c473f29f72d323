// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "authoring/generator/head/head_shape.h"
#include "authoring/paint/uv_raster.h"
#include "character/character.h"

namespace furrow::character::generator {

// The skin of head and hands, painted in model space on the surface that a texel shows, so no seam
// of the unwrapping can be seen.

// Skin, lips, brows, stubble, the shadow of the hair; the inside of the mouth. sRGB.
[[nodiscard]] Picture PaintSkinColour(const Mesh& skin, const HeadShape& shape, int size);
// Pores, larger on nose and cheeks, the fine lines across the pull of the skin and the creases of
// the lips: a tangent-space normal map.
[[nodiscard]] Picture PaintSkinNormals(const Mesh& skin, const HeadShape& shape, int size);
// Roughness in the green channel: oily forehead and nose, moist lips and rims of the lids.
[[nodiscard]] Picture PaintSkinRoughness(const Mesh& skin, int size);
// How thick the flesh is that light passes through, in the green channel: 1 is kFullThickness.
[[nodiscard]] Picture PaintSkinThickness(const Mesh& skin, const HeadShape& shape, int size);
inline constexpr float kFullThickness = 0.03f;  // metres

// How much of a place is lip's red, [0, 1]; head space.
[[nodiscard]] float LipShare(const glm::vec3& p);
// How much of it is covered by hairs of the brows, [0, 1].
[[nodiscard]] float BrowShare(const glm::vec3& p, const FaceParameters& face);
// 1 at the centre of an ellipsoid, falling like a bell over its radii.
[[nodiscard]] float Spot(const glm::vec3& p, const glm::vec3& centre, const glm::vec3& radii);
[[nodiscard]] glm::vec3 Mirrored(const glm::vec3& p);  // onto the left side
[[nodiscard]] bool OnHand(const paint::Texel& texel);  // hands share the atlas of the head

}  // namespace furrow::character::generator
