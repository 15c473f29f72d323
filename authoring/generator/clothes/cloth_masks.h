// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "authoring/generator/clothes/clothes.h"
#include "character/pictures/picture.h"

namespace furrow::authoring {

// The masks of the clothing's regions, four regions in each RGBA picture. Both sides of a joint
// have a mask of their own:
//   elbows     left inner, left outer, right inner, right outer
//   knees      as elbows
//   hips       left front, left back, right front, right back
//   shoulders  as hips
//   waist      front, back, left, right
//   neck       left, right
inline constexpr std::array<const char*, 6> kClothMaskNames = {"cloth_masks_a", "cloth_masks_b",
                                                               "cloth_masks_c", "cloth_masks_d",
                                                               "cloth_masks_e", "cloth_masks_f"};
// `size`: width and height, texels.
[[nodiscard]] std::array<character::Picture, 6> PaintClothMasks(const Clothes& clothes, int size);

}  // namespace furrow::authoring
