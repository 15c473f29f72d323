// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "character/character.h"
#include "render/mesh/joint_bounds.h"

namespace furrow::render {

// What a channel of the mask textures lets through on one material's surfaces: for finding out
// whether a picture shows it, and how large.
struct MaskRegion {
  int channel = 0;  // four a layer
  int material = 0;
  JointBounds bounds;
  float uv_per_metre = 0.0f;  // LeastUvPerMetre() of those surfaces
};

// Appends those of the four channels of `mask`, which is `layer` of the mask textures.
void AddMaskRegions(const character::Character& character, const character::Picture& mask,
                    int layer, std::vector<MaskRegion>* regions);

}  // namespace furrow::render
