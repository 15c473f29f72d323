// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "authoring/bake/request/bake_request.h"
#include "authoring/bake/request/baked_maps.h"
#include "base/status.h"
#include "character/character.h"

namespace furrow::authoring {

// The options that bake the wrinkle maps of a generated character. `size`: width and height of the
// maps, texels. `depth`: multiplier for the height of skin folds, as WrinkleDepth() returns it;
// above 1 (older than 30 years), the skin gets fine lines instead of folds that cross others. All
// others are the defaults of BakeOptions.
[[nodiscard]] BakeOptions WrinkleMapOptions(int size, float depth);

// The strokes of a face whose folds WrinkleMapOptions() makes `depth` times as deep. The skin of
// upper lids is thin: the creases there (strokes named "lid_...") keep the depth of a young face,
// because deeper ones are gashes. So do the ridges of strokes narrower than 4 mm, because skin does
// not fold more sharply outwards.
[[nodiscard]] std::vector<BakeStroke> AgedStrokes(std::span<const BakeStroke> strokes, float depth);

// Bakes the wrinkle maps of the character's rig from the rig's reference poses and from `strokes`,
// and embeds the pictures that the rig names: normals, heights, cavities and colours. `size` and
// `depth`: see WrinkleMapOptions(). Above a depth of 1, the folds of the skin stay in part when the
// face rests (AddRestingFolds()).
// Errors: those of CollectBakePoses(), Bake() and WrinkleMapPictures(); kNotFound (a baked map
// without `normal` in the rig). The character may have some of the pictures after an error.
[[nodiscard]] Status AddWrinkleMaps(std::span<const BakeStroke> strokes, int size, float depth,
                                    character::Character* character);

// Adds a share of a skin map's slopes to a normal map of the same size (16 bits): lines that old
// skin keeps at rest. Pictures of another size stay as they are.
void AddRestingFolds(const BakedMap& map, float share, character::Picture* normals);

}  // namespace furrow::authoring
