// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "character/character.h"

namespace furrow::character {

// Gives each picture without pixels (Undecoded()) a few texels that change as little as possible
// of what is drawn: flat normals and wrinkle maps, empty masks, no emission, white for the rest.
// More than one texel, so that drivers treat the texture as they will treat the real one.
void FillStandIns(Character* character);

}  // namespace furrow::character
