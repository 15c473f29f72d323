// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "authoring/generator/clothes/clothes.h"
#include "character/pictures/picture.h"

namespace furrow::authoring {

// Names of the pictures that PaintClothMasks() returns. Each RGBA picture holds up to four regions,
// in the order of its channels:
//   a  elbows     left inner, left outer, right inner, right outer
//   b  knees      left inner, left outer, right inner, right outer
//   c  hips       left front, left back, right front, right back
//   d  shoulders  left front, left back, right front, right back
//   e  waist      front, back, left, right
//   f  neck left, right; ends of the trousers left, right
//   g  forearms   left, right
inline constexpr std::array<const char*, 7> kClothMaskNames = {
    "cloth_masks_a", "cloth_masks_b", "cloth_masks_c", "cloth_masks_d",
    "cloth_masks_e", "cloth_masks_f", "cloth_masks_g"};
// Paints the masks of the clothes' regions: 8 bits, 0 outside a
// region, at most 255 inside, with soft borders.
// `size`: width and height, texels.
[[nodiscard]] std::array<character::Picture, 7> PaintClothMasks(const Clothes& clothes, int size);

}  // namespace furrow::authoring
