// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "character/mesh/mesh.h"

namespace furrow::character {

// Gives each vertex flagged in `unskinned` (one flag per vertex) the influences of the skinned
// vertex that is the fewest edges away. Without a connected skinned vertex, the influences of a
// vertex at the same position are used, and otherwise `joint` alone. O(n log n) in the size of the
// mesh.
void SpreadInfluences(std::vector<bool> unskinned, int joint, Mesh* mesh);

}  // namespace furrow::character
