// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "character/mesh/mesh.h"

namespace furrow::character {

// Maps every vertex of a mesh to the first vertex that is the same point of the surface: its
// position is equal, its skin weights differ by at most 0.002 for every joint, and every morph
// target moves it alike. The result has one vertex index per vertex. The two sides of a UV seam
// weld, because they come from one vertex of the artist's mesh. Closed lips share positions, but
// joints or morph targets part them, so they do not weld.
[[nodiscard]] std::vector<std::uint32_t> WeldVertices(const Mesh& mesh);

}  // namespace furrow::character
