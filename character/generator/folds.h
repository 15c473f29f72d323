// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "character/character.h"
#include "character/paint/strokes.h"

namespace furrow::character::generator {

// The folds of a face, across the pull of the muscles that make them, in model space on the skin.
// `stretch`: raised brows, widened eyes, corners of the mouth drawn down, raised chin.
[[nodiscard]] std::vector<paint::FoldStroke> StretchStrokes();
// `squash`: frown, nose wrinkled, eyes narrowed, smile.
[[nodiscard]] std::vector<paint::FoldStroke> SquashStrokes();
// Folds of sleeves, trousers and shirt at the joints, laid onto `clothes`.
[[nodiscard]] std::vector<paint::FoldStroke> ClothStrokes(const Mesh& clothes);

}  // namespace furrow::character::generator
