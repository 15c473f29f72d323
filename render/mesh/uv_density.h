// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "character/character.h"

namespace furrow::render {

// Returns the UV distance per metre of surface where the texture is stretched most, in the rest
// pose; 0 for a mesh without surface. Of each triangle, the direction with the most UV distance per
// metre counts. The most stretched twentieth of the surface is ignored as outliers.
[[nodiscard]] float MinUvPerMetre(const character::Mesh& mesh);

}  // namespace furrow::render
