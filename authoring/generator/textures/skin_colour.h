// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/head_shape.h"
#include "character/character.h"

namespace furrow::authoring {

// The colour of the skin of head and hands, sRGB: skin, lips, brows, stubble, roots of the hair,
// the inside of the mouth. Painted in model space at the surface point of each texel, so that UV
// seams are invisible. `size`: width and height, texels.
[[nodiscard]] character::Picture PaintSkinColour(const character::Mesh& skin,
                                                 const HeadShape& shape, int size);

}  // namespace furrow::authoring
