// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "authoring/generator/head/head_shape.h"

// The head's chart: a fractional (column, row) names a place on its surface and in its texture.
// Columns run round the head (0 in front, +-kHeadColumns at the back), rows from the neck to the
// crown; both are denser where the face is. A row is a fan of rays that meet the surface from
// outside.
namespace furrow::authoring {

inline constexpr int kHeadColumns = 30;  // on either side

// Rows of the chart, the first and the last included.
[[nodiscard]] int NumHeadRows();
// The row that has this height in front; -1 where none has.
[[nodiscard]] int FindHeadRow(float height);

// The surface point, head space.
[[nodiscard]] glm::vec3 HeadSurface(const HeadShape& shape, const glm::vec2& place);
// Texture coordinates in the square [0, 1] x [0, 1] of the head's island, v down.
[[nodiscard]] glm::vec2 HeadUv(const glm::vec2& place);
// The place of a point of the face, seen from the front at (x, y); above the chin.
[[nodiscard]] glm::vec2 HeadPlaceAt(const HeadShape& shape, float x, float y);

}  // namespace furrow::authoring
