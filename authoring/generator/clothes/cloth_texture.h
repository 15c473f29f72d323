// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/clothes/clothes.h"
#include "character/character.h"

namespace furrow::authoring {

// Pictures of the clothes' atlas, painted in rest; `size` x `size`.

// Weave, placket and buttons, seams, pockets, wear: sRGB.
[[nodiscard]] character::Picture PaintClothColour(const Clothes& clothes,
                                                  const BodyParameters& body, int size);
// The relief of the same, and the creases that cloth keeps: gathers over the belt and the cuffs,
// the pressed crease of the trousers. Tangent space, green up.
[[nodiscard]] character::Picture PaintClothNormals(const Clothes& clothes, int size);
// Green: shirting is smoother than twill, buttons than either.
[[nodiscard]] character::Picture PaintClothRoughness(const Clothes& clothes, int size);

}  // namespace furrow::authoring
