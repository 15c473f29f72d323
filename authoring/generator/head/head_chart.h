// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "authoring/generator/head/head_shape.h"

// The chart of the head. A fractional (column, row) names a point on the surface and in the
// texture. Columns run around the head (0 in front, +-kHeadColumns at the back); rows run from the
// neck to the crown. Both are denser in the face. A row is a fan of rays that meet the surface from
// outside.
namespace furrow::authoring {

inline constexpr int kHeadColumns = 30;  // on either side

// The number of rows, including the first and the last.
[[nodiscard]] int NumHeadRows();
// The row with this height in front, or -1.
[[nodiscard]] int FindHeadRow(float height);

// The surface point of a place on the chart, head space.
[[nodiscard]] glm::vec3 HeadSurface(const HeadShape& shape, const glm::vec2& place);
// Texture coordinates within the head's island, [0, 1] x [0, 1], v down.
[[nodiscard]] glm::vec2 HeadUv(const glm::vec2& place);
// The place of the point of the face at (x, y), seen from the front. Valid above the chin.
[[nodiscard]] glm::vec2 HeadPlaceAt(const HeadShape& shape, float x, float y);

}  // namespace furrow::authoring
