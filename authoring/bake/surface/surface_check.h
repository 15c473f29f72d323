// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/status.h"
#include "character/character.h"

namespace furrow::authoring {

// The maps of a rig that can be baked.
struct BakeableMaps {
  std::vector<std::string> names;     // at least one
  std::vector<std::string> left_out;  // one sentence for each other map
};

// Checks whether the surfaces of wrinkle maps can be baked. `maps`: names of the maps to check;
// empty: all maps of the rig. Appends to `warnings`, also before an error.
//
// - A map is left out, with a warning, if no mesh is of its kind (skin or cloth) or if the kind has
//   no UVs. It is an error if `maps` names it, or if no map remains.
// - Errors (kInvalidArgument, `where` names the mesh): those, a missing inverse bind matrix, skin
//   weights of a vertex that do not sum to 1; kNotFound: the rig has no such map.
// - Warnings, one sentence each: maps that are left out, overlapping UVs, triangles without area
//   (never drawn), triangles without UVs, UVs outside the picture, meshes that follow a single
//   joint rigidly and have no morph targets.
[[nodiscard]] Result<BakeableMaps> CheckSurfaces(const character::Character& character,
                                                 std::span<const std::string> maps,
                                                 std::vector<std::string>* warnings);

}  // namespace furrow::authoring
