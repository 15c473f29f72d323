// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "authoring/generator/head/head_shape.h"

// The chart of the head: coordinates (column, row) for points of its surface and its texture.
// Fractions are valid. Columns run around the head, 0 in front, +kHeadColumns at the back by way of
// the subject's left, -kHeadColumns by way of the right. Rows run from 0 at the neck to
// NumHeadRows() - 1 at the crown. Both are denser in the face. Head space is in centimetres.
namespace furrow::authoring {

inline constexpr int kHeadColumns = 30;  // columns on each side of the head

// The number of rows, including the first and the last.
[[nodiscard]] int NumHeadRows();
// The row that has the height `height` (y in head space) in the middle of the face, or -1 if the
// chart has no row at exactly this height.
[[nodiscard]] int FindHeadRow(float height);

// The surface point, in head space, at the chart coordinates `place`. Rows are clamped.
[[nodiscard]] glm::vec3 HeadSurface(const HeadShape& shape, const glm::vec2& place);
// The texture coordinates of the chart coordinates `place`, [0, 1] x [0, 1] within the UV island of
// the head, v down.
[[nodiscard]] glm::vec2 HeadUv(const glm::vec2& place);
// The chart coordinates of the surface point that is seen from the front at (x, y), head space.
// Preconditions: x >= 0 (the left side), and y >= -9.15, since rows below are not ordered by
// height.
[[nodiscard]] glm::vec2 HeadPlaceAt(const HeadShape& shape, float x, float y);

}  // namespace furrow::authoring
