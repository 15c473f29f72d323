// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "character/character.h"

namespace furrow::authoring {

// Appends the two triangles of a quad, counter-clockwise from outside. Degenerate triangles
// are left out: a quad whose corners coincide (at a pole or a canthus) adds one triangle or none.
void AddQuad(character::Mesh* mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c,
             std::uint32_t d);

// Computes smooth normals, weighted by area and shared by vertices at the same position, so that UV
// seams do not show. Then computes tangents from the UVs.
void FinishSurface(character::Mesh* mesh);

// One point (x, y) of a piecewise linear function; x increases.
using Knot = std::pair<float, float>;
// The value at `x` of the function through `knots` (at least one); constant beyond both ends.
[[nodiscard]] float Interpolate(std::span<const Knot> knots, float x);

// A bell curve: exp(-(x / width)^2).
[[nodiscard]] float Bump(float x, float width);

}  // namespace furrow::authoring
