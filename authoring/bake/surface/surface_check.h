// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "character/character.h"

namespace furrow::authoring {

// Checks whether the surfaces of wrinkle maps can be baked. `maps`: names of the maps to check;
// empty: all maps of the rig. Appends to `warnings`, also before an error.
//
// - Errors (kInvalidArgument, `where` names the mesh): no mesh of the kind, no UVs, a missing
// inverse
//   bind matrix, skin weights of a vertex that do not sum to 1.
// - Warnings, one sentence each: overlapping UVs, triangles without area (never drawn), triangles
//   without UVs, UVs outside the picture, meshes that follow a single joint rigidly and have no
//   morph targets.
[[nodiscard]] Status CheckSurfaces(const character::Character& character,
                                   std::span<const std::string> maps,
                                   std::vector<std::string>* warnings);

}  // namespace furrow::authoring
