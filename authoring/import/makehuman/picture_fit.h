// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "character/character.h"

namespace furrow::authoring {

// A copy of `picture` with 8 bits per channel and 3 or 4 channels (grey becomes a colour), halved
// until neither side is larger than `size`. Texels are means, weighted by alpha, so that colours
// behind transparent texels do not bleed into the edges. Precondition: the picture has pixels.
[[nodiscard]] character::Picture FitPicture(const character::Picture& picture, int size);

}  // namespace furrow::authoring
