// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/head_shape.h"
#include "character/character.h"

namespace furrow::authoring {

// Pictures of how the skin of head and hands reflects light. `size`: width and height, texels.

// Tangent-space normal map, green up: pores (larger on nose and cheeks), fine lines across the pull
// of the muscles, creases of the lips.
[[nodiscard]] character::Picture PaintSkinNormals(const character::Mesh& skin,
                                                  const HeadShape& shape, int size);
inline constexpr int kSkinNormalBits = 9;  // its precision; see RoundNormals()
// The roughness in the green channel, 0 smooth to 255 rough. Oily skin (forehead, nose) and moist
// skin (lips, rims of the lids) is smoother.
[[nodiscard]] character::Picture PaintSkinRoughness(const character::Mesh& skin, int size);
// Thickness of the flesh that light passes through, in the green channel; 255 is kFullThickness.
[[nodiscard]] character::Picture PaintSkinThickness(const character::Mesh& skin,
                                                    const HeadShape& shape, int size);
inline constexpr float kFullThickness = 0.03f;  // metres

}  // namespace furrow::authoring
