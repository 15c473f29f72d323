// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "character/character.h"

namespace furrow::authoring {

// Appends the two triangles of a quad given counter-clockwise from outside. Corners that fall on
// the same place (a pole, a canthus) leave one triangle or none.
void AddQuad(character::Mesh* mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c,
             std::uint32_t d);

// Smooth normals from the triangles' areas, shared by vertices at the same place, so that UV seams
// do not show. Then tangents from the UVs.
void FinishSurface(character::Mesh* mesh);

// One entry of a piecewise linear function: (x, y), x increasing.
using Knot = std::pair<float, float>;
// Constant beyond both ends.
[[nodiscard]] float Interpolate(std::span<const Knot> knots, float x);

// A bell curve: exp(-(x / width)^2).
[[nodiscard]] float Bump(float x, float width);

}  // namespace furrow::authoring
