// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "character/character.h"
#include "render/gl/gl_objects.h"

namespace furrow::render {

// The heights of a rig's wrinkle maps as one texture array: millimetres above the rest surface,
// half floats, with mips.
struct WrinkleHeights {
  gl::Texture texture;      // 0 if no map has heights
  std::vector<int> layers;  // layer of each wrinkle map of the rig; -1: none
  int side = 1;             // texels of the longer side
  float max_mm = 0.0f;      // largest displacement by one map of weight 1
};

// Makes the texture array. Needs a current context. Maps with missing pictures
// (Character::missing_rig_pictures) have no layer.
[[nodiscard]] WrinkleHeights MakeWrinkleHeights(const character::Character& character);

}  // namespace furrow::render
