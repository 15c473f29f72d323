// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "character/character.h"

namespace furrow::character {

// Gives each vertex of `unskinned` (one flag a vertex) the influences of the skinned vertex that is
// fewest edges away; where no edge leads to one, those of a vertex in the same place, else `joint`
// alone. Linear in the size of the mesh, but for sorting.
void SpreadInfluences(std::vector<bool> unskinned, int joint, Mesh* mesh);

}  // namespace furrow::character
