// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/clothes/clothes.h"
#include "character/character.h"

namespace furrow::authoring {

// Pictures of the clothes' atlas, painted at rest. `size`: width and height, texels.

// Weave, placket and buttons, seams, pockets and wear. sRGB.
[[nodiscard]] character::Picture PaintClothColour(const Clothes& clothes,
                                                  const BodyParameters& body, int size);
// The relief of the same details, and permanent creases: gathers above belt and cuffs, the pressed
// crease of the trousers. Tangent space, green up.
[[nodiscard]] character::Picture PaintClothNormals(const Clothes& clothes, int size);
// Roughness in the green channel. Shirting is smoother than twill, buttons are smoother still.
[[nodiscard]] character::Picture PaintClothRoughness(const Clothes& clothes, int size);

}  // namespace furrow::authoring
