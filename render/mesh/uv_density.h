// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "character/character.h"

namespace furrow::render {

// UV distance per metre of surface where the texture is stretched most, in the rest pose. For each
// triangle, the direction of the highest density counts. The most stretched twentieth of the
// surface is ignored as outliers. 0: the mesh has no surface.
[[nodiscard]] float MinUvPerMetre(const character::Mesh& mesh);

}  // namespace furrow::render
