// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/clothes/clothes.h"
#include "character/character.h"

namespace furrow::authoring {

// Pictures of shirt and trousers in their common UV atlas. `size`: width and height, texels.

// The colour, sRGB: weave, placket and buttons, seams, pockets and wear.
[[nodiscard]] character::Picture PaintClothColour(const Clothes& clothes,
                                                  const BodyParameters& body, int size);
// The tangent-space normal map, green up: weave, buttons, seams, pockets, and permanent creases
// (gathers above belt and cuffs, the pressed crease of the trousers).
[[nodiscard]] character::Picture PaintClothNormals(const Clothes& clothes, int size);
// The roughness in the green channel, 0 smooth to 255 rough: trousers (twill) are roughest, the
// shirt is smoother, buttons are smoothest.
[[nodiscard]] character::Picture PaintClothRoughness(const Clothes& clothes, int size);

}  // namespace furrow::authoring
