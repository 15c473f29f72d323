// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/head_shape.h"
#include "character/character.h"

namespace furrow::authoring {

// How the skin of head and hands reflects light, painted like skin_colour.h. `size`: width and
// height, texels.

// Tangent-space normal map: pores (larger on nose and cheeks), fine lines across the pull of the
// muscles, creases of the lips.
[[nodiscard]] character::Picture PaintSkinNormals(const character::Mesh& skin,
                                                  const HeadShape& shape, int size);
// Roughness in the green channel: forehead and nose are oily, lips and rims of the lids are moist.
[[nodiscard]] character::Picture PaintSkinRoughness(const character::Mesh& skin, int size);
// Thickness of the flesh that light passes through, in the green channel; 1 is kFullThickness.
[[nodiscard]] character::Picture PaintSkinThickness(const character::Mesh& skin,
                                                    const HeadShape& shape, int size);
inline constexpr float kFullThickness = 0.03f;  // metres

}  // namespace furrow::authoring
