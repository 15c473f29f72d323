// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "authoring/bake/request/bake_request.h"
#include "base/status.h"
#include "character/character.h"

namespace furrow::authoring {

// How the skin and clothes of the default character fold, with the defaults of `furrow bake`. Skin
// that folds deeper than at 30 years (`depth` above 1) also has fine lines.
[[nodiscard]] BakeOptions WrinkleMapOptions(int size, float depth);

// Bakes the wrinkle maps of the character's rig from its reference poses and from `strokes`
// (rig/rigs/default.strokes.json). Adds the normals, heights, cavities and colours that the rig
// names. `depth` scales the folds of skin (WrinkleDepth()).
// Errors: those of CollectBakePoses(), Bake() and WrinkleMapPictures(); kNotFound (a baked map
// without `normal` in the rig).
[[nodiscard]] Status AddWrinkleMaps(std::span<const BakeStroke> strokes, int size, float depth,
                                    character::Character* character);

}  // namespace furrow::authoring
