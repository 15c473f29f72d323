// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "character/mesh/mesh.h"

namespace furrow::character {

// Maps every vertex of a mesh to the first vertex that is the same point of the surface: bitwise
// the same position, and moved alike by every joint. The two sides of a UV seam weld, because they
// come from one vertex of the artist's mesh. Closed lips share positions but move apart, so they do
// not.
[[nodiscard]] std::vector<std::uint32_t> WeldVertices(const Mesh& mesh);

}  // namespace furrow::character
