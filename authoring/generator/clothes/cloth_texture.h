// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "authoring/generator/clothes/body_mesh.h"
#include "character/character.h"

namespace furrow::character::generator {

// Pictures of the clothes' atlas, painted in rest; `size` x `size`.

// Weave, placket and buttons, seams, pockets, wear: sRGB.
[[nodiscard]] Picture PaintClothColour(const Clothes& clothes, const BodyParameters& body,
                                       int size);
// The relief of the same, and the creases that cloth keeps: gathers over the belt and the cuffs,
// the pressed crease of the trousers. Tangent space, green up.
[[nodiscard]] Picture PaintClothNormals(const Clothes& clothes, int size);
// Green: shirting is smoother than twill, buttons than either.
[[nodiscard]] Picture PaintClothRoughness(const Clothes& clothes, int size);

// The regions of the clothing, four in each RGBA picture, so that both sides of a joint have a mask
// of their own: elbows (left inner and outer, right inner and outer), knees likewise, hips (left
// front and back, right front and back), shoulders likewise, waist (front, back, left, right), neck
// (left, right).
inline constexpr std::array<const char*, 6> kClothMaskNames = {"cloth_masks_a", "cloth_masks_b",
                                                               "cloth_masks_c", "cloth_masks_d",
                                                               "cloth_masks_e", "cloth_masks_f"};
[[nodiscard]] std::array<Picture, 6> PaintClothMasks(const Clothes& clothes, int size);

}  // namespace furrow::character::generator
