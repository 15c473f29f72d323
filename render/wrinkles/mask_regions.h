// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "character/character.h"
#include "render/mesh/joint_bounds.h"

namespace furrow::render {

// The part of one material's surfaces where one channel of the mask textures is above 0. Used to
// decide whether a picture shows it, and how large.
struct MaskRegion {
  int channel = 0;            // of the mask textures, four per layer
  int material = 0;           // index into Character::materials
  JointBounds bounds;         // of the part
  float uv_per_metre = 0.0f;  // MinUvPerMetre() of the part: UV distance per metre
};

// Appends the regions of the four channels of `mask`, which is `layer` of the mask textures.
void AddMaskRegions(const character::Character& character, const character::Picture& mask,
                    int layer, std::vector<MaskRegion>* regions);

}  // namespace furrow::render
