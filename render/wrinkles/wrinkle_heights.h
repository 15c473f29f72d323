// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "character/character.h"
#include "render/gl/gl_objects.h"

namespace furrow::render {

// The heights of a rig's wrinkle maps as one array on the GPU: millimetres over the rest surface in
// half floats, with mips.
struct WrinkleHeights {
  gl::Texture texture;      // none where no map has heights
  std::vector<int> layers;  // a wrinkle map of the rig -> layer, -1: none
  int side = 1;             // texels of the longer side
  float most_mm = 0.0f;     // furthest that a map at weight 1 can move the surface
};

// Needs a current context. Pictures that nobody has (Character::missing_rig_pictures) are left out.
[[nodiscard]] WrinkleHeights MakeWrinkleHeights(const character::Character& character);

}  // namespace furrow::render
