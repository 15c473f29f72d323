// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "authoring/bake/request/baked_maps.h"
#include "authoring/bake/surface/bake_surface.h"

namespace furrow::authoring {

// The blood of a skin before it folds; one value per welded vertex of the surface.
struct BloodFields {
  std::vector<float> blood;        // per area, relative to rest (BloodSum)
  std::vector<float> arms;         // BendArm(), millimetres
  std::vector<float> amounts;      // SkinSite::blood
  std::vector<float> wavelengths;  // of the folds, metres
};

// Fills map->blood at covered texels, from the heights and cavities of the map; 1 elsewhere.
//
// The blood that furrows press out reddens the triangles around the furrow's vertices. All of it
// stays, where skin is alike on both sides. On meshes with edges much shorter than a furrow, it
// hardly moves. A ridge only spreads its blood over a larger area.
void FillBlood(const BakeSurface& surface, const BloodFields& fields, BakedMap* map);

}  // namespace furrow::authoring
