// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "authoring/bake/request/bake_request.h"
#include "base/status.h"
#include "character/character.h"

namespace furrow::authoring {

// How the default character's skin and clothes fold; what `furrow bake` does by itself. Skin that
// folds deeper than at 30 (`depth` above 1) has fine lines too.
[[nodiscard]] BakeOptions WrinkleMapOptions(int size, float depth);

// Bakes the wrinkle maps of the character's rig from the strain of its own reference poses and from
// `strokes` (rig/rigs/default.strokes.json), and adds to the character the normals, heights,
// cavities and colours that its rig names. `depth` scales what is on skin (WrinkleDepth()).
// Errors: those of CollectBakePoses(), Bake() and WrinkleMapPictures(); kNotFound where a map that
// is baked has no `normal` in the rig.
[[nodiscard]] Status AddWrinkleMaps(std::span<const BakeStroke> strokes, int size, float depth,
                                    character::Character* character);

}  // namespace furrow::authoring
