// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "authoring/bake/request/bake_request.h"
#include "authoring/bake/request/baked_maps.h"
#include "base/status.h"
#include "character/character.h"

// Bakes wrinkle maps from the strain of a skinned surface. Where a pose compresses skin or cloth,
// folds form across the direction of strongest compression. They are high enough to preserve the
// length of the surface. docs/BAKE.md describes the method.
namespace furrow::authoring {

// Bakes every wrinkle map that a pose or a stroke names. `poses`: see CollectBakePoses();
// `strokes`: lines drawn on the rest pose. Both refer to maps and regions of `character.rig` by
// name.
//
// - A map is drawn on the meshes of the surface that the rig names for it. If the rig allows any
//   surface, the map is drawn on skin, or on cloth if there is no skin. Meshes of one kind share
//   one atlas. If no material is marked as skin, every mesh except cloth, eyes and hair is skin.
// - `progress` (optional) is called repeatedly on the calling thread with the completed fraction,
//   [0, 1]. Returning false cancels the bake.
// - The same input gives the same bytes for any number of threads.
// Errors: kInvalidArgument (unknown map or region; count or option out of range; surface missing,
// without UVs or without a triangle of nonzero area; stroke far from the surface), kNonFinite,
// kLimit (folds or strokes too fine for the size of the surface), kUnavailable (cancelled).
// A pose that compresses nothing is valid: its map is flat.
[[nodiscard]] Result<BakedMaps> Bake(const character::Character& character,
                                     std::span<const BakePose> poses,
                                     std::span<const BakeStroke> strokes,
                                     const BakeOptions& options,
                                     const std::function<bool(float)>& progress = {});

}  // namespace furrow::authoring
