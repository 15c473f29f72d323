// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "character/mesh/mesh.h"

namespace furrow::character {

// Gives each vertex that is flagged in `unskinned` (one flag per vertex) the influences of the
// skinned vertex that is the fewest edges away. Vertices at the same position count as one vertex.
// A vertex that no path of edges connects to a skinned one follows `joint` (an index into the
// skeleton) alone. O(n log n) for n vertices and indices.
void SpreadInfluences(std::vector<bool> unskinned, int joint, Mesh* mesh);

}  // namespace furrow::character
