// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "character/character.h"

namespace furrow::character {

// For every vertex of a mesh the first one that is the same point of its surface: it stands at the
// same place (to the bit: the two sides of a UV seam come from one vertex of the artist's) and
// every joint moves it alike. Closed lips, which stand at one place and move apart, are not the
// same.
[[nodiscard]] std::vector<std::uint32_t> WeldVertices(const Mesh& mesh);

}  // namespace furrow::character
