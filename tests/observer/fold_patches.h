// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "authoring/bake/request/bake_request.h"
#include "base/status.h"
#include "character/character.h"
#include "tests/observer/fold_scars.h"

namespace furrow::observer {

// The folds of each map of skin, inside each region that it feeds, where the region's mask is at
// least 0.5. The name is the wrinkle weight's: "brow_l.squash".
//
// - Slopes and heights are those of the character's own pictures.
// - The compression is that of the poses that feed the map of the region, as the bake computes it.
// - `strokes` tells which folds are drawn: those within 1.25 widths of a fold stroke of the map.
// - Wavelengths are those that BakeOptions states for the region.
// Regions without a texture mask and maps without a normal picture are left out. Errors: those of
// BakeSurface::Create() and CollectBakePoses().
[[nodiscard]] Result<std::vector<std::pair<std::string, FoldPatch>>> SkinPatches(
    const character::Character& character, std::span<const authoring::BakeStroke> strokes);

}  // namespace furrow::observer
