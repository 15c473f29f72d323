// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/head_shape.h"
#include "character/character.h"

namespace furrow::authoring {

// Paints the colour of the skin of head and hands, sRGB: skin, lips, brows, stubble, roots of the
// hair, the inside of the mouth. The colour of a texel depends on its surface point, so UV seams
// are invisible. `size`: width and height, texels.
[[nodiscard]] character::Picture PaintSkinColour(const character::Mesh& skin,
                                                 const HeadShape& shape, int size);

}  // namespace furrow::authoring
