// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "authoring/bake/bake.h"

namespace furrow::character::bake {

// Whether the surfaces that `maps` (names; empty: all of the rig's) are drawn on can be baked.
//
// - Refused (kInvalidArgument, `where` the mesh): no mesh of the kind, no UVs, UVs that overlap, an
//   inverse bind matrix too few, a vertex whose skin weights do not sum to 1.
// - Put up with, one sentence each in `warnings`: triangles without area (they are never drawn),
//   triangles without UVs, UVs outside the picture, meshes that follow one joint rigidly.
[[nodiscard]] Status CheckSurfaces(const Character& character, std::span<const std::string> maps,
                                   std::vector<std::string>* warnings);

}  // namespace furrow::character::bake
