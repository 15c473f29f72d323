// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "character/character.h"
#include "character/import/face_landmarks.h"
#include "character/paint/strokes.h"
#include "character/paint/uv_raster.h"

namespace furrow::character {

// Folds run across the pull of the muscle that makes them (facts of the face: FACS' action units).
// Two sheets hold them all; masks and wrinkle weights say where and how much of each shows.

// What raised brows and lowered corners of the mouth make: horizontal furrows of the forehead,
// marionette lines, the crease under the lip and a pebbled chin.
[[nodiscard]] std::vector<paint::FoldStroke> StretchFolds(const FaceLandmarks& face);

// What frowns, sneers, smiles and screwed-up eyes make: verticals of the glabella, the line across
// the nasal root, bunny lines, crow's feet, lines under the eye, nasolabial folds, dimples.
[[nodiscard]] std::vector<paint::FoldStroke> SquashFolds(const FaceLandmarks& face);

// Lays the strokes onto the surface that `texels` cover, smooths them and paints their normal map.
[[nodiscard]] Picture PaintFolds(const char* name, const std::vector<paint::Texel>& texels,
                                 std::vector<paint::FoldStroke> strokes, int size);

}  // namespace furrow::character
